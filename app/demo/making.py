"""Makes the demo: renders beds, takes them into a project, predicts their caps."""

from __future__ import annotations

import os
import shutil
from functools import partial
from pathlib import Path

from fairyring.app.demo.begun import Begun, beds_of, begun, begun_in
from fairyring.app.jobs.finders import network_of
from fairyring.app.jobs.predicting import predict_images
from fairyring.model.predict.shipped import SHIPPED
from fairyring.model.progress import Progress, silent
from fairyring.model.scene.dataset import write_beds
from fairyring.model.scene.presets import preset
from fairyring.model.scene.settings import SceneError
from fairyring.storage.errors import StoreError
from fairyring.storage.folder import is_project
from fairyring.storage.images import ImageFilter, list_ids
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import Project, create_project, open_project


def make_demo(folder: Path, *, count: int, seed: int, progress: Progress = silent) -> None:
    """Makes ``folder`` a project of ``count`` rendered beds with predictions.

    Where that was begun before and interrupted, it goes on with the beds it was begun with. Raises
    StoreError where the folder is a project already, is being made by another process, or cannot be
    written; and whatever ``progress`` raises.
    """
    if begun_in(folder) is None and is_project(folder):
        raise StoreError(f"{folder} is a Fairyring project already; choose another folder.")
    with begun(folder, Begun(count=count, seed=seed)) as demo:
        if not is_project(folder):
            _render(beds_of(folder), demo, progress)
            create_project(folder).close()
        with open_project(folder) as project:
            if not _images_of(project):
                import_paths(project, [beds_of(folder) / "images"], progress=progress)
            predict_images(project, network_of(SHIPPED), _images_of(project), progress=progress)


def _render(beds: Path, demo: Begun, progress: Progress) -> None:
    render = partial(
        write_beds,
        beds,
        preset("default"),
        count=demo.count,
        seed=demo.seed,
        jobs=os.cpu_count() or 1,
        resume=True,
        progress=progress,
    )
    try:
        render()
    except SceneError:
        # Begun by a version whose beds looked different.
        shutil.rmtree(beds)
        render()


def _images_of(project: Project) -> list[int]:
    with project.read() as connection:
        return list_ids(connection, ImageFilter())
