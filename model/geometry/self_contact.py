"""Whether a closed polygon crosses or touches itself."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import Points

PAIRS_AT_ONCE = 1 << 20


def area_if_plainly_simple(xs: list[float], ys: list[float]) -> float:
    """Area of a polygon seen whole from the mean of its vertices, which surely does not touch itself; else 0.

    In plain Python: for the few dozen vertices of a usual outline that is several times faster than numpy.
    """
    middle_x, middle_y = sum(xs) / len(xs), sum(ys) / len(ys)
    here_x, here_y = [x - middle_x for x in xs], [y - middle_y for y in ys]
    next_x, next_y = here_x[1:] + here_x[:1], here_y[1:] + here_y[:1]
    turns = [x * v - y * u for x, y, u, v in zip(here_x, here_y, next_x, next_y, strict=True)]
    if min(turns) <= 0 <= max(turns):
        return 0.0
    times_round = len([1 for y, v in zip(here_y, next_y, strict=True) if y < 0 <= v])
    return abs(sum(turns)) / 2 if times_round == 1 else 0.0


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
