"""What the code imports is what an installation brings: no more, no less."""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

from fairyring.model.network.lite0 import IMAGENET_PACKAGE

TOP = Path(__file__).parents[2]
PROJECT = tomllib.loads((TOP / "pyproject.toml").read_text())["project"]
IN_A_BROWSER = TOP / "app" / "bench" / "browser"
NEVER_IMPORTED_HERE = {"python-multipart"}
"""Starlette imports it when a form is read."""


def distribution_of(requirement: str) -> str:
    """The name of a distribution as the index has it: lower case, hyphens."""
    name = re.match(r"[\w.-]+", requirement)
    assert name, requirement
    return re.sub(r"[-_.]+", "-", name[0]).lower()


def declared(requirements: list[str]) -> set[str]:
    return {distribution_of(requirement) for requirement in requirements}


def third_party_modules_of(file: Path) -> set[str]:
    names: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.add(node.module.split(".")[0])
    return names - sys.stdlib_module_names - {"fairyring"}


def imported_by(files: list[Path]) -> dict[str, list[str]]:
    """Distributions, each with the files that import one of its modules."""
    found: dict[str, list[str]] = {}
    known = packages_distributions()
    for file in files:
        for module in third_party_modules_of(file):
            distribution = distribution_of(known.get(module, [module])[0])
            found.setdefault(distribution, []).append(str(file.relative_to(TOP)))
    return found


@pytest.fixture(scope="module")
def files() -> list[Path]:
    return sorted(file for room in ("app", "model", "storage") for file in (TOP / room).rglob("*.py"))


def test_every_import_is_of_a_declared_dependency(files: list[Path]) -> None:
    imported = imported_by([file for file in files if not file.is_relative_to(IN_A_BROWSER)])
    allowed = declared(PROJECT["dependencies"])
    assert {name: where for name, where in imported.items() if name not in allowed} == {}


def test_what_drives_a_browser_comes_with_the_extra_bench(files: list[Path]) -> None:
    imported = imported_by([file for file in files if file.is_relative_to(IN_A_BROWSER)])
    extra = declared(PROJECT["optional-dependencies"]["bench"])
    assert imported.keys() - declared(PROJECT["dependencies"]) == extra


def test_every_declared_dependency_is_imported(files: list[Path]) -> None:
    unused = declared(PROJECT["dependencies"]) - imported_by(files).keys()
    assert unused == NEVER_IMPORTED_HERE


def test_the_backbones_weights_come_with_the_extra_train() -> None:
    assert declared(PROJECT["optional-dependencies"]["train"]) == {
        distribution_of(name) for name in packages_distributions()[IMAGENET_PACKAGE]
    }
