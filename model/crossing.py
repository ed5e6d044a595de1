"""Whether a closed polygon crosses or touches itself."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from model.geometry import Points

PAIRS_AT_ONCE = 1 << 20


def winds_once(points: Points) -> bool:
    """True for a polygon (n, 2) seen whole from the mean of its vertices: surely simple, and quickly told."""
    x, y = (points - points.mean(axis=0)).T
    after_x, after_y = np.roll(x, -1), np.roll(y, -1)
    turn = x * after_y - y * after_x
    if not (turn > 0).all() and not (turn < 0).all():
        return False
    return np.count_nonzero((y < 0) & (after_y >= 0)) == 1


def self_contact(points: Points) -> Literal["none", "touches", "crosses"]:
    """How the edges of a closed polygon (n, 2) without repeated neighbours meet beyond their shared ends.

    "crosses" where two edges pass through each other; "touches" where at worst an end of one lies on another,
    as on the bridge to a hole.
    """
    ends = np.roll(points, -1, axis=0)
    low, high = np.minimum(points, ends), np.maximum(points, ends)
    axis = int(np.argmax(np.ptp(points, axis=0)))
    order = np.argsort(low[:, axis])
    low, high, starts, ends = low[order], high[order], points[order], ends[order]
    last = np.searchsorted(low[:, axis], high[:, axis], side="right")
    counts = last - np.arange(len(order)) - 1
    blocks = np.cumsum(counts) // PAIRS_AT_ONCE
    worst: Literal["none", "touches"] = "none"
    for block in range(int(blocks[-1]) + 1):
        rows = np.flatnonzero(blocks == block)
        first, second = _pairs(rows, counts[rows])
        other = 1 - axis
        near = (low[first, other] <= high[second, other]) & (low[second, other] <= high[first, other])
        first, second = first[near], second[near]
        gap = np.abs(order[first] - order[second])
        apart = (gap > 1) & (gap < len(order) - 1)
        first, second = first[apart], second[apart]
        sides = _sides(starts[first], ends[first], starts[second], ends[second])
        if (sides < 0).all(axis=0).any():
            return "crosses"
        if (sides <= 0).all(axis=0).any():
            worst = "touches"
    return worst


def _pairs(rows: NDArray[np.int64], counts: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Row i paired with each of the ``counts[i]`` rows after it."""
    first = np.repeat(rows, counts)
    nth = np.arange(len(first)) - np.repeat(np.cumsum(counts) - counts, counts)
    return first, first + 1 + nth


def _sides(a: Points, b: Points, c: Points, d: Points) -> NDArray[np.float64]:
    """(2, n): negative where line ab parts c from d, and where line cd parts a from b; 0 on the line."""

    def side(p: Points, q: Points, r: Points) -> NDArray[np.float64]:
        return np.sign((q[:, 0] - p[:, 0]) * (r[:, 1] - p[:, 1]) - (q[:, 1] - p[:, 1]) * (r[:, 0] - p[:, 0]))

    return np.stack([side(a, b, c) * side(a, b, d), side(c, d, a) * side(c, d, b)])
