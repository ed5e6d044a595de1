"""Windows added to each other, taken from each other, and cut by lines and by caps that lie in front."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.boxes import box_of_outline, touching
from fairyring.model.geometry.raster import mask_of_outline
from fairyring.model.geometry.shapes import Outline, Points, part_of_points, points_of_part
from fairyring.model.predict.overlaps import Window

FINER = 4
"""Outlines of caps in front are drawn on a grid so many times finer than the photo, for their edges."""
SURELY = 6.0
"""Logit of what is surely on a cap; surely not, below 0."""


def value_at(window: Window, point: NDArray[np.float64]) -> float:
    """The logit of the pixel that a point x, y lies in; below 0 outside of the window."""
    column, row = int(point[0]) - window.x, int(point[1]) - window.y
    height, width = window.logits.shape
    inside = 0 <= row < height and 0 <= column < width
    return float(window.logits[row, column]) if inside else -SURELY


def joined(window: Window, other: Window) -> Window:
    """What is on either."""
    left, top = min(window.x, other.x), min(window.y, other.y)
    right = max(window.x + window.logits.shape[1], other.x + other.logits.shape[1])
    bottom = max(window.y + window.logits.shape[0], other.y + other.logits.shape[0])
    around = Window(x=left, y=top, logits=np.full((bottom - top, right - left), -SURELY, np.float32))
    return replace(around, logits=np.maximum(_over(around, window), _over(around, other)))


def without(window: Window, other: Window) -> Window:
    """What is on the window and not on the other."""
    return replace(window, logits=np.minimum(window.logits, -_over(window, other)))


def parted(window: Window, kept: Points, taken: NDArray[np.float64]) -> Window:
    """A window without what lies nearer to the point ``taken`` than to any of those ``kept`` (k, 2)."""
    rows, columns = np.mgrid[: window.logits.shape[0], : window.logits.shape[1]]
    x, y = columns + window.x + 0.5, rows + window.y + 0.5
    nearest = np.min([np.hypot(x - px, y - py) for px, py in kept], axis=0)
    nearer = np.hypot(x - taken[0], y - taken[1]) - nearest
    return replace(window, logits=np.minimum(window.logits, nearer).astype(np.float32))


def behind(window: Window, front: Sequence[Outline]) -> Window:
    """A window without what caps in front hide; their outlines are in the pixels that it counts from."""
    height, width = window.logits.shape
    here = np.array([[window.x, window.y, window.x + width, window.y + height]])
    logits = window.logits
    for outline in front:
        if not touching(here, np.array([box_of_outline(outline)]))[0, 0]:
            continue
        finer = [part_of_points((points_of_part(part) - (window.x, window.y)) * FINER) for part in outline]
        drawn = mask_of_outline(finer, height=height * FINER, width=width * FINER).astype(np.float32)
        share = np.asarray(cv2.resize(drawn, (width, height), interpolation=cv2.INTER_AREA))
        logits = np.minimum(logits, SURELY * (1 - 2 * share))
    return replace(window, logits=logits.astype(np.float32))


def _over(window: Window, other: Window) -> NDArray[np.float32]:
    """The other's logits at the pixels of the window, surely not where it has none."""
    canvas = np.full(window.logits.shape, -SURELY, np.float32)
    height, width = window.logits.shape
    x, y = other.x - window.x, other.y - window.y
    left, top = max(x, 0), max(y, 0)
    right, bottom = min(x + other.logits.shape[1], width), min(y + other.logits.shape[0], height)
    if left < right and top < bottom:
        canvas[top:bottom, left:right] = other.logits[top - y : bottom - y, left - x : right - x]
    return canvas
