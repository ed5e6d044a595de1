"""Annotations against predictions: figures of one cap, of an image, and of every image of the latest run.

Only a mark says where a centre truly is, so caps without one are matched and counted but not measured.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import compress
from statistics import fmean
from typing import TypeVar

import anyio.to_thread

from fairyring.app.caps.cap_figures import Sides, figures_of_caps
from fairyring.app.caps.filling_in import fill_in, one_by_one
from fairyring.app.caps.image_caps import ImageCaps
from fairyring.app.caps.records import prediction_record, truth_record
from fairyring.app.caps.repeated import Marks, marks_on
from fairyring.app.workers.crew import Run, here
from fairyring.model.evaluate import centres
from fairyring.model.geometry.boxes import boxes_of_outlines, touching
from fairyring.storage.compared_caps import CapFigures
from fairyring.storage.comparisons import Comparison, store_comparison
from fairyring.storage.contents import load_annotations, load_latest_run, load_predictions, load_version
from fairyring.storage.images import get_image
from fairyring.storage.open_predictions import covered_by
from fairyring.storage.project import Project
from fairyring.storage.records import Annotation, Image, Outline, Prediction
from fairyring.storage.runs import get_run, predictions_by

Key = TypeVar("Key")
log = logging.getLogger(__name__)

QUIET_S = 1.0
"""Seconds without an edit after which an image's figures are computed anew."""


def compare(
    image: Image, annotations: Sequence[Annotation], predictions: Sequence[Prediction]
) -> centres.Comparison:
    """Pairs the caps of an image. Indices are those of ``annotations`` and ``predictions``."""
    truths = [truth_record(annotation, image) for annotation in annotations]
    guesses = [prediction_record(prediction, image) for prediction in predictions]
    return centres.compare(truths, guesses, width=image.width, height=image.height)


def compare_cap(caps: ImageCaps, uid: str) -> centres.Pair | None:
    """One cap and its matching prediction, found among what lies near it; None where there is none.

    The pair's indices mean nothing to the caller.
    """
    covered = {key: covered_by(a) for key, a in caps.annotations.items() if not a.deleted}
    guesses = {p.id: p for p in caps.predictions}
    near = _near(covered[uid], covered)
    around = _near(covered[uid], {key: p.visible for key, p in guesses.items()})
    found = compare(caps.image, [caps.annotations[key] for key in near], [guesses[key] for key in around])
    return next((pair for pair in found.pairs if near[pair.truth] == uid), None)


def near_cap(annotation: Annotation, said: Sequence[Prediction]) -> list[Prediction]:
    """Those predictions that can match a cap."""
    keys = _near(covered_by(annotation), {nth: each.visible for nth, each in enumerate(said)})
    return [said[nth] for nth in keys]


def _near(outline: Outline, others: Mapping[Key, Outline]) -> list[Key]:
    """The keys of the other outlines whose boxes touch that of ``outline``."""
    (near,) = touching(boxes_of_outlines([outline]), boxes_of_outlines(list(others.values())))
    return list(compress(others, near))


def compare_image(
    project: Project, image_id: int, *, with_run: int | None = None, run: Run = here
) -> Comparison | None:
    """Computes, by ``run``, and stores the figures of one image; None where no network has seen it.

    They are those against the latest run that saw it, unless ``with_run`` names another one.
    """
    fill_in(project, [image_id], compute=one_by_one(run))
    with project.read() as connection:
        version = load_version(connection, image_id)
        image, latest = get_image(connection, image_id), load_latest_run(connection, image_id)
        annotations = load_annotations(connection, image_id)
        if with_run is None:
            predictions = load_predictions(connection, image_id)
        else:
            latest = get_run(connection, with_run)
            predictions = predictions_by(connection, with_run, image_id)
        marks = marks_on(connection, image_id)
    if latest is None:
        return None
    figures, caps = run(_compared, (latest.id, version), image, annotations, predictions, marks)
    project.write(lambda connection: store_comparison(connection, figures, caps=caps))
    return figures


class Reviewer:
    """Keeps the figures of edited images up to date, in the background, one image at a time."""

    def __init__(
        self,
        project: Project,
        *,
        compared: Callable[[int], None],
        run: Run = here,
        quiet_s: float = QUIET_S,
    ) -> None:
        self._project = project
        self._run = run
        self._compared = compared
        self._quiet_s = quiet_s
        self._waiting: dict[int, float] = {}
        self._task: asyncio.Task[None] | None = None

    def touch(self, image_id: int) -> None:
        """Notes that an annotation of this image has changed."""
        self._waiting[image_id] = asyncio.get_running_loop().time() + self._quiet_s
        if self._task is None:
            self._task = asyncio.create_task(self._compare_waiting())

    async def close(self) -> None:
        """Lets the image under way finish and forgets the others; they stay stale in the store."""
        self._waiting.clear()
        if self._task is not None:
            await asyncio.gather(self._task, return_exceptions=True)

    async def _compare_waiting(self) -> None:
        try:
            while self._waiting:
                image_id, due = min(self._waiting.items(), key=lambda item: item[1])
                wait = due - asyncio.get_running_loop().time()
                if wait > 0:
                    await asyncio.sleep(min(wait, self._quiet_s))
                    continue
                del self._waiting[image_id]
                await anyio.to_thread.run_sync(partial(compare_image, self._project, image_id, run=self._run))
                self._compared(image_id)
        except Exception:
            log.exception("An image could not be compared with its predictions.")
        finally:
            self._task = None


def _compared(
    run_and_version: tuple[int, int],
    image: Image,
    annotations: Sequence[Annotation],
    predictions: Sequence[Prediction],
    marks: Marks,
) -> tuple[Comparison, list[CapFigures]]:
    run_id, version = run_and_version
    truths = [truth_record(annotation, image) for annotation in annotations]
    guesses = [prediction_record(prediction, image) for prediction in predictions]
    found = centres.compare(truths, guesses, width=image.width, height=image.height)
    sides = Sides(image=image, annotations=annotations, truths=truths, predictions=predictions, marks=marks)
    caps = figures_of_caps(sides, found, run_id=run_id)
    summary = centres.summarise(found.errors)
    real = [annotation for annotation in annotations if not annotation.cap.ignored]
    worst = max(
        ((pair.error.cdr, annotations[pair.truth].uid) for pair in found.pairs if pair.error), default=None
    )
    dx, dy = summary.bias_px or (None, None)
    known = [cap.floor for cap in caps if cap.cdr is not None and cap.floor is not None]
    overlaps = [pair.iou for pair in found.pairs if pair.iou is not None]
    figures = Comparison(
        image=image.id,
        run=run_id,
        version=version,
        caps=len(real),
        marked=sum(annotation.cap.mark is not None for annotation in real),
        matched=len(found.pairs),
        missed=len(found.missed),
        extra=len(found.extra),
        measured=len(found.errors),
        doubtful=sum(cap.doubtful and not cap.ignored for cap in caps),
        unsure=sum(cap.unsure and not cap.ignored for cap in caps),
        ignored=len(annotations) - len(real),
        cdr_mean=summary.cdr.mean,
        iou_mean=fmean(overlaps) if overlaps else None,
        floor_mean=fmean(known) if known else None,
        cdr_worst=worst[0] if worst else None,
        worst=worst[1] if worst else None,
        px_mean=summary.px.mean,
        relative_mean=summary.relative.mean,
        dx=dx,
        dy=dy,
    )
    return figures, caps
