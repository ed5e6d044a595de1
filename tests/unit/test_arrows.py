"""The dependency arrows: app → storage, model; storage → a little of model; model → nothing of ours."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

TOP = Path(__file__).parents[2]
OURS = ("fairyring", "app", "model", "storage", "static", "tests")
ALLOWED = {
    "app": ("fairyring.app", "fairyring.storage", "fairyring.model"),
    "storage": (
        "fairyring.storage",
        "fairyring.model.geometry",
        "fairyring.model.photo",
        "fairyring.model.errors",
    ),
    "model": ("fairyring.model",),
}
HEAVY = {"torch", "cv2", "numpy", "sqlalchemy", "alembic", "viser", "starlette", "uvicorn", "PIL"}


def imports_of(file: Path) -> set[str]:
    names = set()
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            assert node.level == 0, f"{file} imports relatively"
            names.update({f"{node.module}.{alias.name}" for alias in node.names})
    return names


@pytest.mark.parametrize("package", ALLOWED)
def test_a_package_imports_only_what_its_arrows_allow(package: str) -> None:
    wrong = [
        f"{file.relative_to(TOP)} imports {name}"
        for file in sorted((TOP / package).rglob("*.py"))
        for name in imports_of(file)
        if name.split(".")[0] in OURS
        and not any(name == a or name.startswith(a + ".") for a in ALLOWED[package])
    ]
    assert wrong == []


def test_the_model_of_contours_needs_no_torch() -> None:
    for file in (TOP / "model" / "contour").rglob("*.py"):
        assert not any(name.split(".")[0] == "torch" for name in imports_of(file)), file


def test_the_command_line_imports_nothing_heavy_before_a_command_runs() -> None:
    for file in [TOP / "app" / "cli.py", *(TOP / "app" / "commands").glob("*.py")]:
        at_import = {
            name.split(".")[0]
            for node in ast.parse(file.read_text()).body
            for name in _names_imported_by(node)
        }
        assert not at_import & HEAVY, file


def _names_imported_by(node: ast.stmt) -> list[str]:
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    return [node.module] if isinstance(node, ast.ImportFrom) and node.module else []
