"""The figures of ``fairyring evaluate centres``: of all caps, and of groups of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, get_args

import numpy as np
from msgspec import Struct, to_builtins
from numpy.typing import NDArray

from fairyring.model.coco.document import Document
from fairyring.model.evaluate.bootstrap import Interval, mean_interval
from fairyring.model.evaluate.cap_rows import Measured, measured_caps, visibility_of
from fairyring.model.evaluate.caps import CapRecord
from fairyring.model.evaluate.centres import (
    CentreError,
    Comparison,
    compare,
    compare_by_id,
    summarise,
)
from fairyring.model.evaluate.matching import LEAST_IOU
from fairyring.model.evaluate.pages import Page, Truth, pages_of, truth_of

By = Literal["iou", "id"]
Measure = Literal["cdr", "px", "relative"]
MEASURES: tuple[Measure, ...] = get_args(Measure)
GROUPS = ("size", "visibility", "light", "form")
HALF = 0.5
"""Error over diameter from which two caps are hardly one."""


class CapPairing(Struct, frozen=True, kw_only=True):
    """How caps are paired, and which predictions count."""

    by: By = "iou"
    least_iou: float = LEAST_IOU
    """Least IoU of the masks of a pair; says nothing where caps are paired by id."""
    least_score: float = 0.0
    """Predictions of a lower score are left out."""


USUAL = CapPairing()


class Evaluated(Struct, frozen=True, kw_only=True):
    """Predictions held against a truth, cap by cap."""

    pages: list[Page]
    caps: list[Measured]
    """The caps of all images, image by image."""
    figures: dict[str, Any]
    """What is told of them; ``caps`` there are the rows."""


def evaluate_centres(predicted: Document, truth: Document, pairing: CapPairing = USUAL) -> dict[str, Any]:
    """The figures of ``fairyring evaluate centres`` for two COCO documents or result lists.

    Only the truth's images count. Images are paired by base file name, by their id where one side is a list;
    caps within an image by mask (``compare``) or by annotation id, which reads no segmentation. A cap whose
    prediction has no centre (``contour`` refused it) counts as missed. Raises FairyringError for what is not
    such a document.
    """
    return evaluated(predicted, truth_to_pair(truth, pairing), pairing).figures


def truth_to_pair(truth: Document, pairing: CapPairing) -> Truth:
    """The truth, read as far as this way of pairing needs. Raises DocumentError."""
    return truth_of(truth, masks=pairing.by == "iou", centres=True)


def evaluated(predicted: Document, truth: Truth, pairing: CapPairing) -> Evaluated:
    """``evaluate_centres`` for a truth that was read already, and what the figures are of."""
    paged = pages_of(predicted, truth)
    found = evaluated_pages(paged.pages, pairing)
    found.figures["pairing"] |= to_builtins(paged.pairing)
    return found


def evaluated_pages(pages: list[Page], pairing: CapPairing) -> Evaluated:
    """The same for images in memory, whose predictions below the least score are taken out."""
    caps: list[Measured] = []
    images: list[dict[str, Any]] = []
    apart = 0
    for place, page in enumerate(pages):
        compared = _compared(page, pairing)
        caps.extend(measured_caps(place, page, compared))
        errors = compared.errors
        cdr_mean = summarise(errors).cdr.mean
        images.append({"file_name": page.file_name, "cdr_mean": cdr_mean, "count": len(errors)})
        apart += sum(error.relative is not None and error.relative > HALF for error in errors)
    figures = figures_of_caps(caps) | {
        "extra": sum(cap.truth is None for cap in caps),
        "images": images,
        "pairing": {"apart": apart if pairing.by == "id" else 0},
        "groups": {
            kind: {value: figures_of_caps(some) for value, some in groups.items()}
            for kind, groups in grouped(caps, pages).items()
        },
        "caps": [cap.row for cap in caps],
    }
    return Evaluated(pages=pages, caps=caps, figures=figures)


def grouped(caps: Sequence[Measured], pages: Sequence[Page]) -> dict[str, dict[str, list[Measured]]]:
    """The true caps by each of GROUPS, and by its values; those of which it is not known are in none."""
    groups: dict[str, dict[str, list[Measured]]] = {kind: {} for kind in GROUPS}
    for cap in caps:
        if cap.truth is None:
            continue
        page = pages[cap.page]
        of_cap = (cap.row.size, visibility_of(cap.row), page.light, page.form)
        for kind, value in zip(GROUPS, of_cap, strict=True):
            if value is not None:
                groups[kind].setdefault(value, []).append(cap)
    return {kind: dict(sorted(values.items())) for kind, values in groups.items()}


def _compared(page: Page, pairing: CapPairing) -> Comparison:
    sure = [cap for cap in page.predictions if cap.score >= pairing.least_score]
    if len(sure) < len(page.predictions):
        page.predictions[:] = sure
    if pairing.by == "id":
        found = compare_by_id(page.truths, sure, width=page.width, height=page.height)
    else:
        found = compare(page.truths, sure, width=page.width, height=page.height, least_iou=pairing.least_iou)
    return _refused_as_missed(found, sure)


def _refused_as_missed(comparison: Comparison, predictions: Sequence[CapRecord]) -> Comparison:
    """Counts refused caps as missed: else a method could gain by refusing the caps it finds hard."""
    refused = [pair for pair in comparison.pairs if predictions[pair.prediction].centre is None]
    return Comparison(
        pairs=[pair for pair in comparison.pairs if pair not in refused],
        missed=sorted([*comparison.missed, *(pair.truth for pair in refused)]),
        extra=comparison.extra,
    )


def figures_of_caps(caps: Sequence[Measured]) -> dict[str, Any]:
    """Figures of some caps: errors, their intervals, and how many were found."""
    errors = [cap.error for cap in caps if cap.error]
    images = np.array([cap.page for cap in caps if cap.error], np.int64)
    return {
        **to_builtins(summarise(errors)),
        "intervals": {measure: to_builtins(_interval(errors, images, measure)) for measure in MEASURES},
        "matched": sum(cap.row.outcome == "matched" for cap in caps),
        "missed": sum(cap.row.outcome == "missed" for cap in caps),
    }


def _interval(errors: Sequence[CentreError], images: NDArray[np.int64], measure: Measure) -> Interval | None:
    figures = np.array([getattr(error, measure) for error in errors], np.float64)
    known = ~np.isnan(figures)
    return mean_interval(figures[known], images[known])
