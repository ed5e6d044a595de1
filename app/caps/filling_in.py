"""Works out whole outlines that the store lacks, image by image: after imports, before exports."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Sized
from typing import TypeVar

from msgspec import Struct
from msgspec.structs import replace
from sqlalchemy import Connection

from fairyring.app.caps.fitting import Fitting, known_statistics
from fairyring.app.caps.image_caps import caps_of
from fairyring.app.workers.crew import Run, here
from fairyring.model.contour.marks import reconstruction_of_mark
from fairyring.model.geometry.shapes import Fit
from fairyring.model.progress import Progress, silent
from fairyring.storage import derived
from fairyring.storage.contents import load_contents, load_predictions
from fairyring.storage.images import keep_statistics
from fairyring.storage.project import Project
from fairyring.storage.records import Image, ImageContents, Outline, Prediction

Key = TypeVar("Key")
MOSTLY_NEW = 0.5
"""An image's statistics are measured anew where more than this share of its caps is to be fitted."""


def fill_in(
    project: Project,
    image_ids: Sequence[int] | None = None,
    *,
    run: Run = here,
    progress: Progress = silent,
) -> int:
    """Works out, by ``run``, every whole outline and centre that is missing; returns how many were stored.

    ``image_ids`` None means the whole project. Each image is stored by itself, so that a later call goes on
    where this one was stopped. In a read-only project they stay missing.
    """
    if project.read_only:
        return 0
    if image_ids is None:
        with project.read() as connection:
            image_ids = derived.images_with_underived(connection)
    stored = 0
    for done, image_id in enumerate(image_ids):
        progress(done, len(image_ids), "Finding whole outlines and centres")
        stored += _fill_in_image(project, image_id, run)
    return stored


def _fill_in_image(project: Project, image_id: int, run: Run) -> int:
    with project.read() as connection:
        lacking = derived.underived_of(connection, image_id)
        contents = load_contents(connection, image_id)
        predictions = load_predictions(connection, image_id)
    found = run(_missing, contents, lacking, predictions)

    def store(connection: Connection) -> int:
        if found.statistics is not None:
            keep_statistics(connection, image_id, found.statistics)
        return derived.store_derived(
            connection, image_id, annotations=found.annotations, predictions=found.predictions
        )

    return project.write(store)


class _Found(Struct, frozen=True, kw_only=True):
    """What was worked out for an image."""

    annotations: dict[tuple[str, int], Fit]
    """By uid and revision."""
    predictions: dict[int, Fit]
    statistics: dict[str, float] | None


def _missing(
    contents: ImageContents, lacking: derived.Underived, predictions: Sequence[Prediction]
) -> _Found:
    """The fits that an image lacks."""
    image, caps = contents.image, caps_of(contents)
    said = {prediction.id: prediction.visible for prediction in predictions}
    unmarked = [uid for uid in lacking.annotations if caps.annotations[uid].cap.mark is None]
    # What a run says is fitted by itself: what people correct is not the run's doing.
    of_run = _fitting(image, lacking.predictions, said)
    new_predictions = _fits(of_run, said, lacking.predictions)
    if new_predictions:
        image = replace(image, statistics=of_run.statistics)
    of_all = _fitting(image, unmarked if contents.run is None else (), caps.visible)
    annotations = _fits(of_all, caps.visible, unmarked)
    if annotations:
        image = replace(image, statistics=of_all.statistics)
    marks = {uid: mark for uid in lacking.annotations if (mark := caps.annotations[uid].cap.mark) is not None}
    annotations |= {uid: reconstruction_of_mark(mark).fit for uid, mark in marks.items()}
    return _Found(
        annotations={(uid, caps.annotations[uid].revision): fit for uid, fit in annotations.items()},
        predictions=new_predictions,
        statistics=image.statistics,
    )


def _fitting(image: Image, lacking: Sized, visible: Sized) -> Fitting:
    """The fitting of an image: by statistics measured anew where most caps are new, else by known ones."""
    return Fitting(image, None if len(lacking) > MOSTLY_NEW * len(visible) else known_statistics(image))


def _fits(fitting: Fitting, visible: Mapping[Key, Outline], wanted: Sequence[Key]) -> dict[Key, Fit]:
    if not wanted:
        return {}
    found = fitting.reconstructions([visible[key] for key in wanted], visible=visible.values())
    return {key: each.fit for key, each in zip(wanted, found, strict=True)}
