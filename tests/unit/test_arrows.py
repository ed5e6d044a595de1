"""The dependency arrows between rooms.

A room is a folder of ``app``, ``storage`` or ``model``, or a module beside the folders. In a drawing each
room may import those on lower lines, and none on its own line or above.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

TOP = Path(__file__).parents[2]
DRAWINGS = {
    "app": """
        cli
        commands
        bench  demo  gateway
        report
        panels
        live
        jobs  review
        caps  weights
        workers
        protocol  addresses  settings  editor_commands  static_folder  how_many
    """,
    "storage": """
        exporting_splits
        importing  exporting  backup  about
        taken_out  relinking
        journal  formats  migrations  image_history  reversals
        judging
        statuses  splits  exported_photos
        own_work
        project  images  contents  predictions  runs  provenance  comparisons  derived  ledger
        repeats  compared_runs  second_versions
        change_sets  verdicts  rules  queues  candidates  compared_caps  stored_caps  review_figures
        cap_groups  compared_classes  images_seen
        db  cap_validity  open_predictions  originals
        serving  whole_folders
        records  errors  folder  choices
    """,
    "model": """
        peers
        train
        evaluate  scene
        contour  predict
        network  coco  colour
        geometry  photo  device  json_files  json_values
        errors  progress  light_and_form  splits  whole_files  processes  garbage
    """,
}
OTHER_PACKAGES = {
    "app": ("storage", "model"),
    "storage": (
        *("model.coco", "model.geometry", "model.json_files", "model.json_values"),
        *("model.photo", "model.errors", "model.progress", "model.light_and_form", "model.splits"),
        *("model.processes", "model.garbage"),
    ),
    "model": (),
}
"""What a package may import beside itself."""
HEAVY = {"torch", "cv2", "numpy", "sqlalchemy", "alembic", "viser", "starlette", "uvicorn", "PIL"}


def lines_of(drawing: str) -> dict[str, int]:
    """The line of each room, counted from the top."""
    lines = drawing.strip().splitlines()
    return {room: number for number, line in enumerate(lines) for room in line.split()}


def imports_of(file: Path) -> set[str]:
    """The modules and names a file imports, wherever in it, with dots."""
    names = set()
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            assert node.level == 0, f"{file} imports relatively"
            names.update(f"{node.module}.{alias.name}" for alias in node.names)
    return names


def rooms_of(package: Path) -> Iterator[tuple[str, Path]]:
    """Every module of a package, with the name of its room."""
    for file in sorted(package.rglob("*.py")):
        inside = file.relative_to(package)
        if inside.parts != ("__init__.py",):
            yield inside.parts[0].removesuffix(".py"), file


def arrows_up(package: Path, lines: Mapping[str, int]) -> list[str]:
    """A sentence for every import within a package that does not point down its drawing."""
    wrong = []
    for room, file in rooms_of(package):
        for name in sorted(imports_of(file)):
            top, _, inside = name.partition(f"fairyring.{package.name}.")
            other = inside.split(".")[0]
            if top or other == room or lines[other] > lines[room]:
                continue
            stands = "beside" if lines[other] == lines[room] else "above"
            wrong.append(f"{file.relative_to(package.parent)} imports {name}: {other} stands {stands} {room}")
    return wrong


@pytest.mark.parametrize("package", DRAWINGS)
def test_every_room_is_in_its_drawing(package: str) -> None:
    assert {room for room, _ in rooms_of(TOP / package)} == set(lines_of(DRAWINGS[package]))


@pytest.mark.parametrize("package", DRAWINGS)
def test_every_arrow_between_rooms_points_down(package: str) -> None:
    assert arrows_up(TOP / package, lines_of(DRAWINGS[package])) == []


def test_an_arrow_that_points_up_is_named_with_its_file(tmp_path: Path) -> None:
    package = tmp_path / "house"
    for room in ("attic", "cellar", "larder"):
        (package / room).mkdir(parents=True)
        (package / room / "shelf.py").write_text("import fairyring.house.larder.shelf\n")
    late = "def fetch():\n    from fairyring.house.attic import trunk\n"
    (package / "cellar" / "shelf.py").write_text("import fairyring.house.larder.jam\n" + late)
    assert arrows_up(package, lines_of("attic\ncellar larder")) == [
        "house/cellar/shelf.py imports fairyring.house.attic.trunk: attic stands above cellar",
        "house/cellar/shelf.py imports fairyring.house.larder.jam: larder stands beside cellar",
    ]


@pytest.mark.parametrize("package", DRAWINGS)
def test_a_package_imports_of_the_others_only_what_it_may(package: str) -> None:
    allowed = tuple(f"fairyring.{name}." for name in (package, *OTHER_PACKAGES[package]))
    wrong = [
        f"{file.relative_to(TOP)} imports {name}"
        for _, file in rooms_of(TOP / package)
        for name in imports_of(file)
        if name.split(".")[0] in ("fairyring", "app", "model", "storage", "static", "tests")
        and not f"{name}.".startswith(allowed)
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
