"""An import that is killed, wherever that happens, leaves nothing behind that a later one does not clear."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import PIL.Image
import pytest

from fairyring.storage.images import ImageFilter, list_images
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.importing.staging import clear_killed_imports
from fairyring.storage.project import create_project, open_project

KILLING = """
import os, signal, sys
from pathlib import Path
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.importing.staging import Staging
from fairyring.storage.project import open_project

def killed_after(work):
    def run(*args):
        work(*args)
        os.kill(os.getpid(), signal.SIGKILL)
    return run

with open_project(Path(sys.argv[1])) as project:
    owner = project if sys.argv[3] == "write" else Staging
    setattr(owner, sys.argv[3], killed_after(getattr(owner, sys.argv[3])))
    import_paths(project, [Path(sys.argv[2])])
"""


def import_killed_after(step: str, beds: Path, photos: Path) -> None:
    ran = subprocess.run([sys.executable, "-c", KILLING, beds, photos, step], check=False)
    assert ran.returncode == -signal.SIGKILL


@pytest.fixture
def photos(tmp_path: Path) -> Path:
    (tmp_path / "photos").mkdir()
    for name in ("bed_1.png", "bed_2.png"):
        pixels = np.random.default_rng(len(name)).integers(0, 255, (40, 60, 3), np.uint8)
        PIL.Image.fromarray(pixels).save(tmp_path / "photos" / name)
    return tmp_path / "photos"


def names_in(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize(
    ("step", "left"), [("copy", 0), ("move_in", 2)], ids=["while copying", "between the files and the rows"]
)
def test_what_a_killed_import_left_is_cleared(tmp_path: Path, photos: Path, step: str, left: int) -> None:
    create_project(tmp_path / "beds").close()
    images = tmp_path / "beds" / "images"
    import_killed_after(step, tmp_path / "beds", photos)
    assert len(names_in(images)) == 1 + left

    with open_project(tmp_path / "beds") as project:
        clear_killed_imports(project)
        assert names_in(images) == []
        assert import_paths(project, [photos]).images == 2
        with project.read() as connection:
            assert list_images(connection, ImageFilter()).total == 2
    assert names_in(images) == names_in(photos)


def test_what_a_killed_import_had_entered_stays(tmp_path: Path, photos: Path) -> None:
    """It is killed after its rows were committed, before its copies were cleared away."""
    create_project(tmp_path / "beds").close()
    images = tmp_path / "beds" / "images"
    import_killed_after("write", tmp_path / "beds", photos)
    assert len(names_in(images)) == 3

    with open_project(tmp_path / "beds") as project:
        report = import_paths(project, [photos])
        assert (report.images, report.images_known) == (0, 2)
    assert names_in(images) == names_in(photos)
