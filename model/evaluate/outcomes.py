"""The outcome of every true cap and prediction, from which success rates, precision and recall are counted.

One matching at IoU .5 answers for every score: predictions take their caps in order of falling score, so
that leaving out the ones below some score changes nothing above it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from fairyring.model.errors import FairyringError
from fairyring.model.evaluate.excursions import strays
from fairyring.model.evaluate.matching import LEAST_IOU, mask_of, pairs_by_score, unmatched_in_ignored
from fairyring.model.evaluate.pages import Page
from fairyring.model.geometry.raster import area_of_rle, covered_matrix, iou_matrix

LEAST_SCORE = 0.5
"""Least score of a prediction that counts as certain."""
CLOSE_IOU = 0.75
FINE_IOU = 0.85
"""IoU of outlines that a person hardly needs to touch."""
COVERING = 0.5
"""A prediction covers a cap if it covers this share of the cap's pixels."""

Flags = NDArray[np.bool_]
Figures = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Outcomes:
    """Outcomes of n true caps that are not ignored, and of m predictions, of one image or many."""

    area: Figures
    """(n,) visible pixels."""
    diameter: Figures
    """(n,) px: of the whole cap where the truth states a circle or an ellipse, else of the circle that has
    the visible area. A cap does not become small because another one lies over it."""
    found: Flags
    """(n,) has a partner of score ≥ .5 at IoU ≥ .5."""
    closely: Flags
    """(n,) the same at IoU ≥ .75."""
    fine: Flags
    """(n,) found, and its partner's IoU is ≥ .85."""
    strays: Flags
    """(n,) found, and its partner's outline has an excursion: see ``excursions.strays``."""
    alone: Flags
    """(n,) found, and exactly one prediction of score ≥ .5 covers half of the cap or more, and that
    prediction covers half or more of no other cap. (Whoever overlaps a cap with IoU ≥ .5 covers half of it,
    so this leaves out caps that were found twice, and caps taken for one with another. Fragments that
    cover less show in the precision.)"""
    score: Figures
    """(m,)"""
    right: Flags
    """(m,) has a partner at IoU ≥ .5."""
    dropped: Flags
    """(m,) has none and lies in ignored regions: counts neither way, not as a duplicate either."""


def outcomes_of_page(page: Page) -> Outcomes:
    """The outcomes of one image. Raises FairyringError for an infinite score or a cap without a mask."""
    real = [cap for cap in page.truths if not cap.ignored]
    truths, predictions = [mask_of(cap) for cap in real], [mask_of(cap) for cap in page.predictions]
    scores = np.array([cap.score for cap in page.predictions], dtype=np.float64)
    if not np.isfinite(scores).all():
        raise FairyringError(f"A prediction in {page.file_name} has a score that is not a finite number.")
    iou = iou_matrix(truths, predictions)
    pairs = pairs_by_score(iou, scores, least=LEAST_IOU)
    matched = {prediction for _, prediction in pairs}
    dropped = _flags(len(predictions), unmatched_in_ignored(page.truths, page.predictions, matched=matched))
    firm = (scores >= LEAST_SCORE) & ~dropped
    found = _found(pairs, firm, count=len(real))
    partners = [(truth, prediction) for truth, prediction in pairs if firm[prediction]]
    area = np.array([area_of_rle(rle) for rle in truths], dtype=np.float64)
    covers = covered_matrix(truths, predictions)[:, firm] >= COVERING
    covers_one = covers & (covers.sum(axis=0) == 1)
    return Outcomes(
        area=area,
        diameter=np.array(
            [cap.diameter or 2 * math.sqrt(pixels / math.pi) for cap, pixels in zip(real, area, strict=True)]
        ),
        found=found,
        closely=_found(pairs_by_score(iou, scores, least=CLOSE_IOU), firm, count=len(real)),
        fine=_flags(len(real), {t for t, p in partners if iou[t, p] >= FINE_IOU}),
        strays=_flags(len(real), {t for t, p in partners if strays(predictions[p], truths[t])}),
        alone=found & (covers.sum(axis=1) == 1) & covers_one.any(axis=1),
        score=scores,
        right=_flags(len(predictions), matched),
        dropped=dropped,
    )


def joined(outcomes: Sequence[Outcomes]) -> Outcomes:
    """The outcomes of several images, at least one, as if they were one."""
    columns = [field.name for field in fields(Outcomes)]
    return Outcomes(**{name: np.concatenate([getattr(one, name) for one in outcomes]) for name in columns})


def _found(pairs: list[tuple[int, int]], firm: Flags, *, count: int) -> Flags:
    return _flags(count, {truth for truth, prediction in pairs if firm[prediction]})


def _flags(count: int, places: set[int]) -> Flags:
    flags = np.zeros(count, dtype=bool)
    flags[list(places)] = True
    return flags
