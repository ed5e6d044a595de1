"""Predictions without a network: the true visible masks, distorted by a seeded noise model.

Their run is of the kind ``simulated``, and the page says so.
"""

from __future__ import annotations

from pathlib import Path

import msgspec
from sqlalchemy import Connection

from model.scene.dataset import DOCUMENT
from model.scene.distort import WAVER_PX, Simulated, TrueCap, distort_caps
from storage.images import find_image
from storage.predictions import NewPrediction, add_predictions, add_run
from storage.project import Project

RUN = "simulated"


def simulate(project: Project, beds: Path, *, seed: int) -> None:
    """Enters a run over the images of ``beds``, a folder that ``write_beds`` made."""
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
