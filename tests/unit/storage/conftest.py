"""Projects, photos and label files to try the store on."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest

from fairyring.storage.importing.paths import import_paths
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.project import create_project, open_project

SQUARE = [[10.0, 10.0, 30.0, 10.0, 30.0, 30.0, 10.0, 30.0]]
TRIANGLE = [[40.0, 40.0, 60.0, 40.0, 50.0, 60.0]]


@pytest.fixture
def square():
    """A visible outline of 20 × 20 px whose top left corner is (10, 10)."""
    return [list(part) for part in SQUARE]


def write_noise(path: Path, *, width: int = 100, height: int = 80, seed: int = 0) -> Path:
    rng = np.random.default_rng([seed, *path.name.encode()])
    path.parent.mkdir(parents=True, exist_ok=True)
    assert cv2.imwrite(str(path), rng.integers(0, 255, (height, width, 3), np.uint8))
    return path


@pytest.fixture(scope="session")
def write_photo():
    """Writes a photo whose content depends on its name and seed."""
    return write_noise


@pytest.fixture
def write_coco(tmp_path):
    """Writes a COCO file; annotations get ids, image 1 and category 1 unless they say otherwise."""

    def write(annotations, *, images=None, path=tmp_path / "labels" / "labels.json", **keys) -> Path:
        path.parent.mkdir(parents=True, exist_ok=True)
        images = images or [{"id": 1, "file_name": "bed_1.png", "width": 100, "height": 80}]
        numbered = [
            {"id": number, "image_id": 1, "category_id": 1} | entry if isinstance(entry, dict) else entry
            for number, entry in enumerate(annotations, start=1)
        ]
        document = {"images": images, "annotations": numbered, "categories": [{"id": 1, "name": "mushroom"}]}
        path.write_text(json.dumps(document | keys))
        return path

    return write


@pytest.fixture(scope="session")
def empty_project(tmp_path_factory):
    """A project folder to copy, which is quicker than migrating anew for every test."""
    folder = tmp_path_factory.mktemp("empty") / "beds"
    create_project(folder).close()
    return folder


@pytest.fixture(scope="session")
def project_of_three(tmp_path_factory, write_photo):
    """A project folder to copy, of three photos."""
    folder = tmp_path_factory.mktemp("three")
    photos = [write_photo(folder / "photos" / name) for name in ("bed_1.png", "bed_2.png", "bed_10.png")]
    with create_project(folder / "beds") as project:
        import_paths(project, photos)
    return folder / "beds"


@pytest.fixture
def out(tmp_path):
    """Where to export to."""
    return tmp_path / "out"


@pytest.fixture
def project(empty_project, tmp_path):
    """An empty project."""
    with open_project(shutil.copytree(empty_project, tmp_path / "beds")) as opened:
        yield opened


@pytest.fixture
def beds(project_of_three, tmp_path):
    """A project of three photos, bed_1.png, bed_2.png and bed_10.png, with ids 1, 2 and 3."""
    with open_project(shutil.copytree(project_of_three, tmp_path / "beds")) as opened:
        yield opened


@pytest.fixture
def predicted(beds):
    """The project ``beds`` with one prediction on its first image, of a run called r."""
    beds.write(
        lambda c: add_predictions(
            c,
            run_id=add_run(c, name="r", kind="network").id,
            image_id=1,
            predictions=[NewPrediction(visible=SQUARE, score=0.5)],
        )
    )
    return beds
