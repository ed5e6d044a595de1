"""Two runs, or what two weights predicted, side by side on the same images: before and after a training."""

from __future__ import annotations

from typing import Any

from fairyring.app.review.figures import Review, ReviewedCap, figures_of, review_of
from fairyring.model.errors import FairyringError
from fairyring.model.evaluate.centre_figures import Evaluated
from fairyring.model.evaluate.two_runs import difference_of
from fairyring.model.progress import Progress, silent
from fairyring.storage.project import Project
from fairyring.storage.records import Run
from fairyring.storage.runs import images_seen_by

MOST_CHANGED = 24
"""How many of the caps that changed most are listed."""
SHOWN = ("cdr", "floor", "px", "relative", "matched", "missed", "extra")


def reviews_of_both(
    project: Project,
    first: Run,
    second: Run,
    *,
    images: str = "*",
    only_sure: bool = False,
    progress: Progress = silent,
) -> tuple[Review, Review]:
    """Both runs against the images that both saw and somebody worked on.

    Args:
        project: whose images.
        first: the run before.
        second: the run after.
        images: only images of these file names, which may hold ``*`` and ``?``.
        only_sure: leaves out doubtful caps and marks that hardly determine a centre.
        progress: called once an image and run.

    Raises:
        FairyringError: there is no such image.
    """
    with project.read() as connection:
        seen = [{image.id for image in images_seen_by(connection, run.id)} for run in (first, second)]
    both = seen[0] & seen[1]
    reviews = tuple(
        review_of(project, run=run, images=images, among=both, only_sure=only_sure, progress=progress)
        for run in (first, second)
    )
    if not reviews[0].images:
        raise FairyringError(f"There is no image with labels that both {first.name} and {second.name} saw.")
    return reviews[0], reviews[1]


def side_by_side(first: Review, second: Review) -> dict[str, Any]:
    """The figures of both, what the second is off by more than the first, and the caps that changed most."""
    difference = difference_of(_evaluated(first), _evaluated(second))
    return {
        "images": len(first.images),
        "first": _shown(first),
        "second": _shown(second),
        "difference": difference,
        "changed": [_changed(*pair) for pair in changed_most(first, second)],
    }


def changed_most(
    first: Review, second: Review, *, most: int = MOST_CHANGED
) -> list[tuple[ReviewedCap, ReviewedCap]]:
    """The caps whose centre one of the two has much nearer to the mark than the other, the largest first."""
    before = {cap.key: cap for cap in first.caps if cap.measured.error}
    pairs = [(before[cap.key], cap) for cap in second.caps if cap.measured.error and cap.key in before]
    return sorted(pairs, key=lambda pair: abs(_nearer(*pair)), reverse=True)[:most]


def _nearer(first: ReviewedCap, second: ReviewedCap) -> float:
    assert first.measured.error is not None, "measured caps alone are paired"
    assert second.measured.error is not None, "measured caps alone are paired"
    return second.measured.error.px - first.measured.error.px


def _changed(first: ReviewedCap, second: ReviewedCap) -> dict[str, Any]:
    row = first.measured.row
    return {
        "image": row.image,
        "cap": row.truth,
        "name": first.name,
        "floor": first.floor,
        "first": {"cdr": row.cdr, "px": row.px},
        "second": {"cdr": second.measured.row.cdr, "px": second.measured.row.px},
    }


def _shown(review: Review) -> dict[str, Any]:
    figures = figures_of(review)
    own = {} if review.run is None else {"run": review.run.name, "weights": review.run.weights}
    return own | {name: figures[name] for name in SHOWN}


def _evaluated(review: Review) -> Evaluated:
    measured = [cap.measured for cap in review.caps]
    return Evaluated(pages=review.pages, caps=measured, figures={})
