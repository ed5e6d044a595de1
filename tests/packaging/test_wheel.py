"""The wheel holds what the checkout holds, as one package, and nothing else."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

TOP = Path(__file__).parents[2]
ROOMS = ("app", "model", "storage", "static")


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A clean copy: setuptools leaves ``build/`` where it builds, and takes from it what is gone since."""
    copy = tmp_path_factory.mktemp("copy")
    for room in ROOMS:
        shutil.copytree(TOP / room, copy / room, ignore=shutil.ignore_patterns("__pycache__"))
    for file in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(TOP / file, copy)
    return copy


@pytest.fixture(scope="module")
def names(copy: Path) -> set[str]:
    """Of the files in the wheel."""
    wheel = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--wheel-dir", copy / "wheel", copy]
    subprocess.run(wheel, check=True, capture_output=True)
    return set(zipfile.ZipFile(next((copy / "wheel").glob("*.whl"))).namelist())


def test_the_wheel_holds_every_file_of_the_rooms_and_only_those(copy: Path, names: set[str]) -> None:
    files = [file for room in ROOMS for file in (copy / room).rglob("*") if file.is_file()]
    ours = {name for name in names if not name.split("/")[0].endswith(".dist-info")}
    assert ours == {f"fairyring/{file.relative_to(copy).as_posix()}" for file in files}


def test_the_packages_named_are_the_folders_that_hold_modules(copy: Path) -> None:
    named = tomllib.loads((copy / "pyproject.toml").read_text())["tool"]["setuptools"]["packages"]
    holding = {file.parent.relative_to(copy) for room in ROOMS for file in (copy / room).rglob("*.py")}
    assert set(named) == {".".join(("fairyring", *folder.parts)) for folder in holding | {Path("static")}}
    assert len(named) == len(set(named))


def test_the_licence_and_the_command_come_with_it(names: set[str]) -> None:
    in_metadata = {name.partition(".dist-info/")[2] for name in names if ".dist-info/" in name}
    assert {"licenses/LICENSE", "entry_points.txt"} <= in_metadata
