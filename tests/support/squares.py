"""Square caps on a page, and the figures of predictions on it."""

from __future__ import annotations

from typing import Any

import numpy as np

from fairyring.model.evaluate.caps import CapRecord
from fairyring.model.evaluate.masks import MaskScores, score_masks
from fairyring.model.evaluate.pages import Page
from fairyring.model.geometry.raster import rle_of_mask

WIDTH, HEIGHT = 400, 200


def box(x: int, y: int, w: int, h: int) -> dict[str, Any]:
    mask = np.zeros((HEIGHT, WIDTH), np.uint8)
    mask[y : y + h, x : x + w] = 1
    return rle_of_mask(mask)


def cap(x: int, y: int, w: int = 40, h: int = 40, **other: Any) -> CapRecord:
    """40 × 40 unless told otherwise: the circle of that area measures 45 px."""
    return CapRecord(rle=box(x, y, w, h), **other)


def page(truths: list[CapRecord], predictions: list[CapRecord], **other: Any) -> Page:
    named = {"file_name": "a.png", **other}
    return Page(width=WIDTH, height=HEIGHT, truths=truths, predictions=predictions, **named)


def scores(truths: list[CapRecord], predictions: list[CapRecord]) -> MaskScores:
    return score_masks([page(truths, predictions)])
