"""The demo project: rendered beds, and what the shipped weights see in them."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from fairyring.app.caps.whole_outlines import Progress
from fairyring.app.jobs.predicting import network_of, predict_images
from fairyring.model.predict.shipped import SHIPPED
from fairyring.model.scene.dataset import write_beds
from fairyring.model.scene.presets import preset
from fairyring.storage.images import ImageFilter, list_ids
from fairyring.storage.importing.run import import_paths
from fairyring.storage.project import create_project


def make_demo(folder: Path, *, count: int, seed: int, progress: Progress = lambda *_: None) -> None:
    """Makes ``folder`` a project of ``count`` rendered beds with predictions.

    Raises StoreError where the folder is a project already, or cannot be written.
    """
    with create_project(folder) as project, tempfile.TemporaryDirectory() as rendered:
        beds = Path(rendered)
        write_beds(
            beds, preset("default"), count=count, seed=seed, jobs=os.cpu_count() or 1, progress=progress
        )
        import_paths(project, [beds / "images"])
        with project.read() as connection:
            images = list_ids(connection, ImageFilter())
        predict_images(project, network_of(SHIPPED), images, progress=progress)
