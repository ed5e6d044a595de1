"""One row a cap: which prediction found it, how far off the centre is, and what kind of cap it is."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from msgspec import Struct

from fairyring.model.coco.ids import Id
from fairyring.model.evaluate.caps import CapRecord
from fairyring.model.evaluate.centres import CentreError, Comparison
from fairyring.model.evaluate.pages import Page
from fairyring.model.evaluate.sizes import size_of_cap

LITTLE, WHOLE = 0.6, 0.95
"""Share in sight below which little of a cap is seen, and from which on nothing to speak of is hidden."""

Outcome = Literal["matched", "missed", "extra"]


class CapRow(Struct, frozen=True, kw_only=True):
    """A true cap with its prediction, or a prediction that has none; None for what is not known."""

    image: str
    outcome: Outcome
    truth: Id | None = None
    """Id in the truth; ``prediction`` in the predictions."""
    prediction: Id | None = None
    dx: float | None = None
    """Predicted minus true x, pixels; ``dy`` likewise."""
    dy: float | None = None
    px: float | None = None
    cdr: float | None = None
    """CDR, percent (Eq. 10)."""
    relative: float | None = None
    """Error as a share of the diameter."""
    diameter: float | None = None
    """Of the whole true cap, pixels; of an extra one, as predicted."""
    visible_share: float | None = None
    """How much of the whole true cap is in sight."""
    size: str | None = None
    """By visible area, as COCO has it, s, m or l; ``under_30_px`` by diameter."""
    shape: str | None = None
    """Regular or irregular, as the predictions say, else the truth."""
    mark: str | None = None
    """What the true centre was taken from: polygon, circle, ellipse or centre."""
    score: float | None = None
    iou: float | None = None
    """IoU of the masks; None where the two were paired by id."""


class Measured(Struct, frozen=True, kw_only=True):
    """A row, with what it was made of."""

    row: CapRow
    page: int
    """Place of its image."""
    truth: int | None
    """Index of the true cap in its image; None of an extra prediction."""
    error: CentreError | None
    """None where there is no pair, or one of the two has no centre."""


def measured_caps(place: int, page: Page, comparison: Comparison) -> Iterator[Measured]:
    """The caps that count of the image at this place: matched ones, then missed ones, then extra ones."""
    for pair in comparison.pairs:
        guess = page.predictions[pair.prediction]
        row = _row(page, page.truths[pair.truth], guess, pair.error, iou=pair.iou)
        yield Measured(row=row, page=place, truth=pair.truth, error=pair.error)
    for truth in comparison.missed:
        row = _row(page, page.truths[truth], None, None)
        yield Measured(row=row, page=place, truth=truth, error=None)
    for prediction in comparison.extra:
        yield Measured(row=_extra_row(page, page.predictions[prediction]), page=place, truth=None, error=None)


def visibility_of(row: CapRow) -> str | None:
    """How much of a cap is in sight, in three classes."""
    return visibility_class(row.visible_share)


def visibility_class(share: float | None) -> str | None:
    """The same of the share of the whole cap that is in sight, 0 to 1."""
    if share is None:
        return None
    if share < LITTLE:
        return "under_60_percent"
    return "60_to_95_percent" if share < WHOLE else "95_percent_and_more"


def _row(
    page: Page,
    cap: CapRecord,
    guess: CapRecord | None,
    error: CentreError | None,
    *,
    iou: float | None = None,
) -> CapRow:
    return CapRow(
        image=page.file_name,
        outcome="matched" if guess else "missed",
        truth=cap.id,
        prediction=guess.id if guess else None,
        dx=error.dx if error else None,
        dy=error.dy if error else None,
        px=error.px if error else None,
        cdr=error.cdr if error else None,
        relative=error.relative if error else None,
        diameter=cap.diameter,
        visible_share=cap.visible_share,
        size=size_of_cap(cap),
        shape=(guess.shape if guess else None) or cap.shape,
        mark=cap.mark,
        score=guess.score if guess else None,
        iou=iou,
    )


def _extra_row(page: Page, guess: CapRecord) -> CapRow:
    return CapRow(
        image=page.file_name,
        outcome="extra",
        prediction=guess.id,
        diameter=guess.diameter,
        size=size_of_cap(guess),
        shape=guess.shape,
        score=guess.score,
    )
