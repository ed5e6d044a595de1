"""What the network still knows once it has learnt from a photo of which only a few caps are labelled."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec

from fairyring.app.bench.network.sets import LabelledPhotos
from fairyring.app.bench.network.tables import predicted_document
from fairyring.app.jobs.training import Asked, train_as_asked
from fairyring.model.coco.document import document_of
from fairyring.model.evaluate.masks import evaluate_masks
from fairyring.model.photo import Pixels
from fairyring.model.predict.seen import Detection
from fairyring.model.progress import Progress, silent
from fairyring.model.train.divergence import DivergenceError
from fairyring.storage.importing.intake import Facts
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import create_project
from fairyring.storage.records import Status

MOST_TURNS = 2
"""So many photos of a set are learnt from, one after the other."""
FIGURES = ("S50", "S75", "AP")
SAID: dict[Status, str] = {"new": "to do", "annotated": "called complete"}
"""What is said of the photo that is learnt from: the truth, and what is not so."""


@dataclass(frozen=True, kw_only=True)
class Lesson:
    """What is learnt, and by whom."""

    weights: Path
    detector_of: Callable[[Path], Callable[[Pixels], list[Detection]]]
    """What detects caps in a photo, (height, width, 3) RGB, with the weights of a file."""
    caps: int
    """How many caps of the photo are labelled."""
    iterations: int
    device: str


def partly_labelled_rows(
    lesson: Lesson, photos: LabelledPhotos, *, folder: Path, progress: Progress = silent
) -> list[dict[str, Any]]:
    """Figures on the other photos of a set before anything was learnt, and after each lesson.

    Projects and weights are made in ``folder``. A set of one photo gives no rows.
    """
    rows: list[dict[str, Any]] = []
    for learnt, others in _turns(photos):
        before = _figures(lesson, lesson.weights, others, progress)
        rows.append(_row(photos.name, learnt, before, before, said="start"))
        for status, words in SAID.items():
            work = folder / f"{photos.name}-{learnt.photos[0].stem}-{status}".replace(" ", "-")
            said = f"{lesson.caps} caps, {words}"
            try:
                weights = _trained(lesson, learnt, work, status=status, progress=progress)
                after = _figures(lesson, weights, others, progress)
            except DivergenceError:
                after, said = {}, f"{said}: stopped, as its loss ran away"
            rows.append(_row(photos.name, learnt, after, before, said=said))
    return rows


def _turns(photos: LabelledPhotos) -> Iterator[tuple[LabelledPhotos, LabelledPhotos]]:
    """A photo to learn from, and the others of the set."""
    places = range(len(photos.photos))
    for learnt in places[:MOST_TURNS] if len(places) > 1 else ():
        yield photos.at([learnt]), photos.at([place for place in places if place != learnt])


def _trained(
    lesson: Lesson, photo: LabelledPhotos, folder: Path, *, status: Status, progress: Progress
) -> Path:
    """The weights trained further on a project of this photo, in which a few caps are labelled."""
    folder.mkdir()
    labels = folder / "labels.json"
    labels.write_bytes(msgspec.json.encode(_few_caps_of(photo.document, lesson.caps)))
    with create_project(folder / "project") as project:
        import_paths(project, [photo.photos[0]], link=True)
        import_paths(project, [labels], unsaid=Facts(status=status))
    trained = train_as_asked(
        [folder / "project"],
        folder / "training",
        Asked(weights=str(lesson.weights), iterations=lesson.iterations),
        device=lesson.device,
        workers=None,
        progress=progress,
        say=lambda _: None,
    )
    return trained.weights


def _few_caps_of(document: dict[str, Any], count: int) -> dict[str, Any]:
    """The document of one image with so many of its certain caps, spread over the list."""
    image = document["images"][0]["id"]
    caps = [
        cap
        for cap in document["annotations"]
        if cap["image_id"] == image and not (cap.get("ignore") or cap.get("iscrowd") or cap.get("doubt"))
    ]
    step = max(len(caps) // count, 1)
    kept = ("id", "image_id", "category_id", "segmentation")
    few = [{key: cap[key] for key in kept} for cap in caps[step // 2 :: step][:count]]
    return {"images": document["images"], "categories": document["categories"], "annotations": few}


def _figures(lesson: Lesson, weights: Path, photos: LabelledPhotos, progress: Progress) -> dict[str, Any]:
    said = predicted_document(lesson.detector_of(weights), photos, progress=progress)
    return evaluate_masks(document_of(said), document_of(photos.document))


def _row(
    name: str, learnt: LabelledPhotos, figures: dict[str, Any], before: dict[str, Any], *, said: str
) -> dict[str, Any]:
    return {
        "set": name,
        "learnt_from": learnt.photos[0].name,
        "labelled": said,
        **{key: round(figures[key], 4) if figures else None for key in FIGURES},
        "S50_change": round(figures["S50"] - before["S50"], 4) if figures else None,
    }
