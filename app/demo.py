"""The demo project: rendered beds, and predictions that are the truth as a careless model would see it.

Until trained weights ship, the predictions are the true visible masks distorted by a seeded noise model;
their run is named ``simulated``, and the page says so.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import msgspec
from sqlalchemy import Connection

from app.derive import Progress, fill_in
from model.scene.dataset import DOCUMENT, write_beds
from model.scene.distort import WAVER_PX, Simulated, TrueCap, distort_caps
from model.scene.presets import preset
from storage.images import find_image
from storage.importing import import_paths
from storage.predictions import NewPrediction, add_predictions, add_run
from storage.project import Project, create_project

RUN = "simulated"


def make_demo(folder: Path, *, count: int, seed: int, progress: Progress = lambda *_: None) -> None:
    """Makes ``folder`` a project of ``count`` rendered beds with a run of simulated predictions.

    Raises:
        StoreError: the folder is a project already, or cannot be written.
    """
    with create_project(folder) as project, tempfile.TemporaryDirectory() as rendered:
        beds = Path(rendered)
        write_beds(
            beds, preset("default"), count=count, seed=seed, jobs=os.cpu_count() or 1, progress=progress
        )
        import_paths(project, [beds / "images"])
        _simulate(project, beds, seed=seed)
        fill_in(project, progress=progress)


def _simulate(project: Project, beds: Path, *, seed: int) -> None:
    document = msgspec.json.decode((beds / DOCUMENT).read_bytes())
    truth: dict[int, list[TrueCap]] = {}
    for cap in document["annotations"]:
        truth.setdefault(cap["image_id"], []).append(TrueCap(cap["segmentation"], cap["visible_fraction"]))
    with project.read() as connection:
        images = {bed["id"]: find_image(connection, bed["file_name"]) for bed in document["images"]}
    said = [
        (image.id, distort_caps(truth.get(key, []), width=image.width, height=image.height, seed=seed + key))
        for key, image in images.items()
        if image is not None
    ]
    project.write(lambda connection: _enter(connection, said, seed=seed))


def _enter(connection: Connection, said: list[tuple[int, list[Simulated]]], *, seed: int) -> None:
    run = add_run(connection, name=RUN, kind="simulated", settings={"seed": seed, "waver_px": WAVER_PX})
    for image_id, caps in said:
        new = [NewPrediction(visible=cap.visible, score=cap.score) for cap in caps]
        add_predictions(connection, run_id=run.id, image_id=image_id, predictions=new)
