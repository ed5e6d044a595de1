"""Works out whole outlines that the store lacks, image by image.

An import stores what files say and no more; whatever reads whole outlines or centres calls `fill_in` first:
for the images it reads. What is lacking stands in `storage.derived`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Sized
from contextlib import suppress
from typing import Protocol, TypeVar

from msgspec import Struct
from msgspec.structs import replace
from sqlalchemy import Connection

from fairyring.app.caps.fitting import NOTHING_SAID, Fitting, Likely, Seen, known_statistics
from fairyring.app.caps.image_caps import caps_of
from fairyring.app.workers.crew import Run
from fairyring.model.contour.marks import reconstruction_of_mark
from fairyring.model.geometry.shapes import Fit
from fairyring.model.processes import usable_cores, worked_on
from fairyring.model.progress import Progress, silent
from fairyring.storage import derived
from fairyring.storage.contents import load_contents
from fairyring.storage.errors import StoreError
from fairyring.storage.images import keep_statistics
from fairyring.storage.project import Project
from fairyring.storage.records import Image, ImageContents, Prediction
from fairyring.storage.runs import predictions_by

Key = TypeVar("Key")
Task = TypeVar("Task")
Found = TypeVar("Found")
WHAT = "Finding whole outlines and centres"
MOSTLY_NEW = 0.5
"""An image's statistics are measured anew where more than this share of its caps is to be fitted."""
WORTH_PROCESSES = 12
"""Images from which several processes are sooner done than one, which need not be started."""


class Compute(Protocol):
    """Calls a function with each of several tasks, in whatever process, and yields what it returns."""

    def __call__(self, work: Callable[[Task], Found], tasks: Iterable[Task], /) -> Iterator[Found]: ...


def one_by_one(run: Run) -> Compute:
    """Computes by ``run``, one task after the other."""

    def compute(work: Callable[[Task], Found], tasks: Iterable[Task], /) -> Iterator[Found]:
        return (run(work, task) for task in tasks)

    return compute


def on_all_cores(work: Callable[[Task], Found], tasks: Iterable[Task], /) -> Iterator[Found]:
    """Computes by as many processes as this one may use cores."""
    return worked_on(work, tasks, jobs=usable_cores())


def fill_in(
    project: Project,
    image_ids: Sequence[int] | None = None,
    *,
    compute: Compute | None = None,
    progress: Progress = silent,
) -> int:
    """Works out every whole outline and centre that is missing; returns how many were stored.

    Args:
        project: whose images; one that is read-only keeps them until it is closed.
        image_ids: which; None for all.
        compute: who does the work; None for this process, or for many images all cores.
        progress: called once an image; what it raises ends the work, and a later call goes on there.
    """
    with project.read() as connection:
        lacking = derived.images_with_underived(connection, image_ids)
    if compute is None:
        compute = on_all_cores if len(lacking) >= WORTH_PROCESSES else map
    stored = 0
    progress(0, len(lacking), WHAT)
    tasks = (task for image_id in lacking if (task := _read(project, image_id)) is not None)
    for done, found in enumerate(compute(_missing, tasks), start=1):
        stored += _store(project, found)
        progress(done, len(lacking), WHAT)
    return stored


class _Lacking(Struct, frozen=True, kw_only=True):
    """An image, and what it lacks."""

    contents: ImageContents
    lacking: derived.Underived
    said: dict[int, list[Prediction]]
    """All that the runs said which lack any, by run."""


class _Found(Struct, frozen=True, kw_only=True):
    """What was worked out for an image."""

    image: int
    annotations: dict[tuple[str, int], Fit]
    """By uid and revision."""
    predictions: dict[int, Fit]
    statistics: dict[str, float] | None


def _read(project: Project, image_id: int) -> _Lacking | None:
    """None where the image has been taken out meanwhile."""
    with suppress(StoreError), project.read() as connection:
        lacking = derived.underived_of(connection, image_id)
        return _Lacking(
            contents=load_contents(connection, image_id),
            lacking=lacking,
            said={run: predictions_by(connection, run, image_id) for run in lacking.predictions},
        )
    return None


def _store(project: Project, found: _Found) -> int:
    def store(connection: Connection) -> int:
        if found.statistics is not None:
            keep_statistics(connection, found.image, found.statistics)
        return derived.store_derived(
            connection, found.image, annotations=found.annotations, predictions=found.predictions
        )

    return project.keep(store)


def _missing(task: _Lacking) -> _Found:
    """The fits that an image lacks."""
    contents, lacking = task.contents, task.lacking
    image, caps = contents.image, caps_of(contents)
    predictions: dict[int, Fit] = {}
    for run, wanted in lacking.predictions.items():
        # What a run says is fitted by itself: what people correct is not the run's doing.
        said = {prediction.id: Seen(prediction.visible) for prediction in task.said[run]}
        of_run = _fitting(contents.image, wanted, said)
        predictions |= _fits(of_run, said, wanted)
        if contents.run is not None and run == contents.run.id:
            image = replace(image, statistics=of_run.statistics)
    unmarked = [uid for uid in lacking.annotations if caps.annotations[uid].cap.mark is None]
    new = unmarked if contents.run is None else ()
    of_all = _fitting(image, new, caps.visible, caps.fitting.likely)
    annotations = _fits(of_all, caps.visible, unmarked)
    if annotations:
        image = replace(image, statistics=of_all.statistics)
    marks = {uid: mark for uid in lacking.annotations if (mark := caps.annotations[uid].cap.mark) is not None}
    annotations |= {uid: reconstruction_of_mark(mark).fit for uid, mark in marks.items()}
    return _Found(
        image=image.id,
        annotations={(uid, caps.annotations[uid].revision): fit for uid, fit in annotations.items()},
        predictions=predictions,
        statistics=image.statistics,
    )


def _fitting(image: Image, lacking: Sized, visible: Sized, likely: Likely = NOTHING_SAID) -> Fitting:
    """The fitting of an image: by statistics measured anew where most caps are new, else by known ones."""
    mostly_new = len(lacking) > MOSTLY_NEW * len(visible)
    return Fitting(image, None if mostly_new else known_statistics(image), likely)


def _fits(fitting: Fitting, visible: Mapping[Key, Seen], wanted: Sequence[Key]) -> dict[Key, Fit]:
    if not wanted:
        return {}
    found = fitting.reconstructions([visible[key] for key in wanted], visible=visible.values())
    return {key: each.fit for key, each in zip(wanted, found, strict=True)}
