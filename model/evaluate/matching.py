"""Matches predictions with true caps one to one, and finds those that count neither way."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
from numpy.typing import NDArray

from fairyring.model.errors import FairyringError
from fairyring.model.evaluate.caps import CapRecord
from fairyring.model.geometry.raster import Rle, shares_inside

LEAST_IOU = 0.5
"""Least IoU of a true cap and the prediction matched with it."""
IGNORED_SHARE = 0.5
"""An unmatched prediction with this share of its area in ignored regions counts neither way."""


def pairs_by_overlap(iou: NDArray[np.float64], *, least: float) -> list[tuple[int, int]]:
    """(truth, prediction) pairs in order of falling IoU (truths, predictions), each row and column once.

    The best of several predictions gets the cap: for measuring how good it is.
    """
    rows, columns = np.nonzero(iou >= least)
    order = np.argsort(-iou[rows, columns], kind="stable")
    pairs: list[tuple[int, int]] = []
    free_rows, free_columns = set(rows.tolist()), set(columns.tolist())
    for row, column in zip(rows[order].tolist(), columns[order].tolist(), strict=True):
        if row in free_rows and column in free_columns:
            pairs.append((row, column))
            free_rows.remove(row)
            free_columns.remove(column)
    return pairs


def pairs_by_score(
    iou: NDArray[np.float64], scores: NDArray[np.float64], *, least: float
) -> list[tuple[int, int]]:
    """(truth, prediction) pairs as COCO makes them: in order of falling score, each takes the free cap it
    overlaps most.

    For counting: whoever is matched above some score does not depend on the predictions below it.
    """
    left = np.where(iou >= least, iou, 0.0)
    pairs: list[tuple[int, int]] = []
    for prediction in np.argsort(-scores, kind="stable").tolist() if len(iou) else []:
        truth = int(left[:, prediction].argmax())
        if left[truth, prediction]:
            pairs.append((truth, prediction))
            left[truth] = 0.0
    return pairs


def unmatched_in_ignored(
    truths: Sequence[CapRecord], predictions: Sequence[CapRecord], *, matched: Collection[int]
) -> set[int]:
    """The predictions without a partner that lie, by IGNORED_SHARE or more, in ignored regions."""
    single = [index for index in range(len(predictions)) if index not in matched]
    ignored = [mask_of(truth) for truth in truths if truth.ignored]
    shares = shares_inside([mask_of(predictions[index]) for index in single], ignored)
    return {index for index, share in zip(single, shares, strict=True) if share >= IGNORED_SHARE}


def mask_of(cap: CapRecord) -> Rle:
    """Its visible pixels; FairyringError where it was read without."""
    if cap.rle is None:
        raise FairyringError("Caps without masks can only be paired by id.")
    return cap.rle
