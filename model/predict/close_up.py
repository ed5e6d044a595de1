"""A closer look where somebody points: buds are too small for the network in a photo seen as a whole."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fairyring.model.geometry.raster import rle_of_outline
from fairyring.model.geometry.shapes import Outline, area_of_outline
from fairyring.model.photo import Pixels
from fairyring.model.predict.passes import Pass, resized
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.seen import Detection, Seen

SIDE = 64
"""Pixels of the photo that are seen around a click, where the photo was not seen smaller than it is,"""
LEAST = 48
"""and at least, pixels of the scaled photo."""
GIVEN = 160
"""Pixels a side that the network is given of it: a bud of 15 pixels is 38 wide then."""
SMALL = 30
"""Caps of a smaller diameter than this are looked at closely; for a side of SIDE pixels."""
MOST = 36
"""Wider than this, what a closer look shows may be a part of something larger."""


def cap_at_points(
    predictor: Predictor,
    photo: Pixels,
    seen: Seen,
    points: Sequence[tuple[float, float]],
    labels: Sequence[bool] = (True,),
    *,
    front: Sequence[Outline] = (),
) -> Detection | None:
    """As `Predictor.at`; where that shows nothing or something small, the photo is looked at closely.

    ``photo`` (height, width, 3) uint8 RGB is the one that was seen.
    """
    found = predictor.at(seen, points, labels, front=front)
    side = _side_of(seen)
    if found is not None and _diameter(found) >= SMALL * side / SIDE:
        return found
    left, top = (max(0, min(round(at - side / 2), length - side)) for at, length in _axes(seen, points[0]))
    moved = [(x - left, y - top) for x, y in points]
    if not all(0 <= x < side and 0 <= y < side for x, y in moved):
        return found
    close_up = _seen_closely(predictor, photo[top : top + side, left : left + side])
    close = predictor.at(close_up, moved, labels, front=[_moved(outline, -left, -top) for outline in front])
    if close is None or _diameter(close) >= MOST * side / SIDE:
        return found
    outline = _moved(close.outline, left, top)
    rle = rle_of_outline(outline, height=seen.height, width=seen.width)
    return replace(close, outline=outline, rle=rle, whole=close.whole and close.whole.moved(left, top))


def _side_of(seen: Seen) -> int:
    """Of the square that is looked at, pixels of the photo."""
    return max(SIDE, round(LEAST * seen.width / seen.scaled[0]))


def _axes(seen: Seen, point: tuple[float, float]) -> list[tuple[float, int]]:
    return [(point[0], seen.width), (point[1], seen.height)]


def _seen_closely(predictor: Predictor, piece: Pixels) -> Seen:
    height, width = piece.shape[:2]
    scaled = resized(np.ascontiguousarray(piece), GIVEN / max(height, width))
    return Seen(width=width, height=height, photo=scaled, pieces=predictor.go_over(scaled, Pass()))


def _diameter(found: Detection) -> float:
    """Of a circle of its visible area, pixels."""
    return math.sqrt(4 * area_of_outline(found.outline) / math.pi)


def _moved(outline: Outline, dx: float, dy: float) -> Outline:
    by = np.array([dx, dy])
    return [(np.reshape(part, (-1, 2)) + by).ravel().tolist() for part in outline]
