"""Strokes of a hand that knows where the rim is: round a whole cap, or where an outline strays from it."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import Points, points_of_part

EVERY_PX = 1.0
"""Distance of two points of a stroke, image pixels."""
ON_RIM_PX = 1.5
"""An outline that lies nearer to the rim than this lies on it, image pixels."""
OVERLAP_PX = 3.0
"""A stroke begins and ends so far along the part of the outline that is right, image pixels."""


def round_of(part: Sequence[float]) -> Points:
    """(n, 2) points round a part of an outline x0, y0, x1, y1, …, evenly apart; the last is the first."""
    corners = points_of_part(list(part))
    closed = np.vstack([corners, corners[:1]])
    run = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(closed, axis=0).T))])
    at = np.linspace(0.0, run[-1], max(8, round(run[-1] / EVERY_PX)) + 1)
    return np.column_stack([np.interp(at, run, closed[:, axis]) for axis in (0, 1)])


def stray_line(said: Sequence[float], rim: Sequence[float]) -> Points:
    """(n, 2) points of the rim from before the outline ``said`` strays from it to after that.

    All but the longest stretch where the outline is right; where it is right nowhere, the way round from
    where it comes nearest.
    """
    points = round_of(rim)[:-1]
    away = distances_to(said, points)
    right = away <= ON_RIM_PX
    if right.all() or not right.any():
        return np.roll(points, -int(away.argmin()), axis=0)
    first, count = _longest_run(right)
    spare = min(int(OVERLAP_PX / EVERY_PX), (count - 1) // 2)
    # From the last points of the stretch that is right round to its first ones.
    start = first + count - 1 - spare
    length = len(points) - count + 2 * spare + 2
    return points[(start + np.arange(length)) % len(points)]


def distances_to(part: Sequence[float], points: Points) -> NDArray[np.float64]:
    """(n,) distances of points (n, 2) from a part of an outline."""
    corners = points_of_part(list(part)).astype(np.float32)[:, None]
    return np.array([abs(cv2.pointPolygonTest(corners, (float(x), float(y)), True)) for x, y in points])


def _longest_run(flags: NDArray[np.bool_]) -> tuple[int, int]:
    """Where the longest run of true begins in flags that go round, and how long it is."""
    count = len(flags)
    doubled = np.concatenate([flags, flags]).astype(np.int8)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], doubled, [0]])))
    starts, lengths = edges[::2], np.diff(edges)[::2]
    longest = int(lengths.argmax())
    return int(starts[longest]) % count, min(int(lengths[longest]), count)
