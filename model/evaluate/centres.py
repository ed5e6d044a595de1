"""Errors of predicted centres: matching, Eq. 10, and figures over many caps.

CDR shrinks as the image grows, so every figure stands beside the error in pixels and over the cap's
diameter; the signed error shows a bias that absolute figures hide; and caps that found no partner are
counted apart, never averaged away.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from msgspec import Struct

from fairyring.model.evaluate.caps import CapRecord
from fairyring.model.evaluate.matching import LEAST_IOU, mask_of, pairs_by_overlap, unmatched_in_ignored
from fairyring.model.geometry.raster import iou_matrix
from fairyring.model.geometry.shapes import Centre


class CentreError(Struct, frozen=True, kw_only=True):
    """A predicted centre against the true one."""

    cdr: float
    """CDR, percent (Eq. 10)."""
    px: float
    relative: float | None
    """Error as a share of the cap's diameter; None where that is not known."""
    dx: float
    """Predicted minus true x, pixels; ``dy`` likewise."""
    dy: float


class Pair(Struct, frozen=True, kw_only=True):
    """A truth and its prediction, as indices into what was compared."""

    truth: int
    prediction: int
    iou: float | None
    """IoU of the masks; None where the two were paired by id."""
    error: CentreError | None
    """Error of the centre; None where one of them has no centre."""


class Comparison(Struct, frozen=True, kw_only=True):
    """The truths and predictions of one image. Indices are those of the sequences compared."""

    pairs: list[Pair]
    missed: list[int]
    """Indices of truths without a prediction, ignored ones left out."""
    extra: list[int]
    """Indices of predictions without a truth, those in ignored regions left out."""

    @property
    def errors(self) -> list[CentreError]:
        return [pair.error for pair in self.pairs if pair.error]


class Spread(Struct, frozen=True, kw_only=True):
    """Mean, median and 95th percentile; all None where there was nothing to average."""

    mean: float | None = None
    median: float | None = None
    p95: float | None = None


class Summary(Struct, frozen=True, kw_only=True):
    """Centre errors of many caps."""

    cdr: Spread
    """CDR, percent."""
    px: Spread
    relative: Spread
    bias_px: tuple[float, float] | None
    """Mean signed error in x and y, pixels."""


def centre_error(
    predicted: Centre, true: Centre, *, width: int, height: int, diameter: float | None
) -> CentreError:
    """Eq. 10, E = (|Δx| / W + |Δy| / H) · 100 %, of an image of this size, and what stands beside it."""
    dx, dy = predicted[0] - true[0], predicted[1] - true[1]
    px = math.hypot(dx, dy)
    return CentreError(
        cdr=100 * (abs(dx) / width + abs(dy) / height),
        px=px,
        relative=px / diameter if diameter else None,
        dx=dx,
        dy=dy,
    )


def compare(
    truths: Sequence[CapRecord],
    predictions: Sequence[CapRecord],
    *,
    width: int,
    height: int,
    least_iou: float = LEAST_IOU,
) -> Comparison:
    """Pairs the caps of one image one to one by their masks and measures their centres.

    Pairs are taken in order of falling IoU down to ``least_iou``. Between visible masks, which hardly overlap
    among themselves, a mask has at most one partner above a half, and the order then decides nothing; where
    predictions do overlap, the best one gets the cap. Ignored truths take no partner.
    """
    real = [index for index, truth in enumerate(truths) if not truth.ignored]
    iou = iou_matrix([mask_of(truths[index]) for index in real], [mask_of(cap) for cap in predictions])
    pairs = [
        _pair(truths, predictions, real[row], column, iou=float(iou[row, column]), size=(width, height))
        for row, column in pairs_by_overlap(iou, least=least_iou)
    ]
    found, used = {pair.truth for pair in pairs}, {pair.prediction for pair in pairs}
    neither_way = unmatched_in_ignored(truths, predictions, matched=used)
    return Comparison(
        pairs=pairs,
        missed=[index for index in real if index not in found],
        extra=[index for index in range(len(predictions)) if index not in used | neither_way],
    )


def compare_by_id(
    truths: Sequence[CapRecord], predictions: Sequence[CapRecord], *, width: int, height: int
) -> Comparison:
    """Pairs the caps of one image that have the same id, without a look at their masks."""
    place = {cap.id: index for index, cap in enumerate(predictions)}
    ignored = {cap.id for cap in truths if cap.ignored}
    real = [index for index, cap in enumerate(truths) if not cap.ignored]
    pairs = [
        _pair(truths, predictions, index, place[truths[index].id], iou=None, size=(width, height))
        for index in real
        if truths[index].id in place
    ]
    found, used = {pair.truth for pair in pairs}, {pair.prediction for pair in pairs}
    return Comparison(
        pairs=pairs,
        missed=[index for index in real if index not in found],
        extra=[i for i, cap in enumerate(predictions) if i not in used and cap.id not in ignored],
    )


def summarise(errors: Sequence[CentreError]) -> Summary:
    """Mean, median and 95th percentile over caps, of one image or many."""
    bias = (
        (float(np.mean([e.dx for e in errors])), float(np.mean([e.dy for e in errors]))) if errors else None
    )
    return Summary(
        cdr=_spread([e.cdr for e in errors]),
        px=_spread([e.px for e in errors]),
        relative=_spread([e.relative for e in errors if e.relative is not None]),
        bias_px=bias,
    )


def _pair(
    truths: Sequence[CapRecord],
    predictions: Sequence[CapRecord],
    truth: int,
    prediction: int,
    *,
    iou: float | None,
    size: tuple[int, int],
) -> Pair:
    cap, guess = truths[truth], predictions[prediction]
    error = None
    if cap.centre and guess.centre:
        error = centre_error(guess.centre, cap.centre, width=size[0], height=size[1], diameter=cap.diameter)
    return Pair(truth=truth, prediction=prediction, iou=iou, error=error)


def _spread(figures: Sequence[float]) -> Spread:
    if not figures:
        return Spread()
    return Spread(
        mean=float(np.mean(figures)),
        median=float(np.median(figures)),
        p95=float(np.percentile(figures, 95)),
    )
