"""Whether, and how often, a closed polygon crosses or touches itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import GeometryError, Points

MOST_PAIRS = 1_000_000
"""Most pairs of edges that are compared: any two of 1400. Of a rim's, few lie beside each other."""
MOST_CROSSINGS = 1000
"""Most crossings; an outline that crosses itself more often is not meant as a cap."""
PAIRS_AT_ONCE = 1 << 14
ON_LINE = 1e-9
"""A point nearer to a line than this, pixels, lies on it: where lines cross is known no better."""

Plane = NDArray[np.complexfloating[Any, Any]]
"""(n,) vectors: x and y as real and imaginary part."""


@dataclass(frozen=True)
class Contact:
    """How the edges of a closed polygon meet beyond their shared ends."""

    pairs: int
    """Pairs of edges that lay beside each other and were compared."""
    crossings: int
    """Of these, pairs that pass through each other; not counted much beyond MOST_CROSSINGS."""
    touches: bool
    """An end of one edge lies on another, as on the bridge to a hole."""


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


def self_contact(points: Points, *, most_pairs: int = MOST_PAIRS) -> Contact:
    """How a closed polygon (n, 2) without repeated neighbours meets itself.

    Raises GeometryError where more than ``most_pairs`` of its edges lie beside each other: that is counted
    before any two are compared.
    """
    ends = np.roll(points, -1, axis=0)
    low, high = np.minimum(points, ends), np.maximum(points, ends)
    axis, order, counts = _sweep(low, high)
    if (pairs := int(counts.sum())) > most_pairs:
        raise GeometryError(
            f"A polygon of {len(points)} points has too many long edges side by side; draw it with fewer."
        )
    beside_low, beside_high = low[order, 1 - axis], high[order, 1 - axis]
    starts, edges = (vectors[order] @ (1, 1j) for vectors in (points, ends - points))
    blocks = np.cumsum(counts) // PAIRS_AT_ONCE
    crossings, touches = 0, False
    for block in np.split(np.arange(len(order)), np.flatnonzero(np.diff(blocks)) + 1):
        first, second = _pairs(block, counts[block])
        near = (beside_low[first] <= beside_high[second]) & (beside_low[second] <= beside_high[first])
        first, second = first[near], second[near]
        gap = np.abs(order[first] - order[second])
        apart = (gap > 1) & (gap < len(order) - 1)
        first, second = first[apart], second[apart]
        away = starts[second] - starts[first]
        one, other = _parts(edges[first], edges[second], away), _parts(edges[second], edges[first], -away)
        crossings += int(np.count_nonzero((one < 0) & (other < 0)))
        touches = touches or bool(((one <= 0) & (other <= 0) & (one * other == 0)).any())
        if crossings > MOST_CROSSINGS:
            break
    return Contact(pairs=pairs, crossings=crossings, touches=touches)


def _sweep(low: Points, high: Points) -> tuple[int, NDArray[np.int64], NDArray[np.int64]]:
    """The axis along which fewer edges lie beside each other, their order along it by their lower ends,
    and with how many of those that follow each one overlaps there."""
    orders = np.argsort(low, axis=0).T
    counts = []
    for axis, order in enumerate(orders):
        last = np.searchsorted(low[order, axis], high[order, axis], side="right")
        counts.append(last - np.arange(len(order)) - 1)
    axis = int(np.argmin([each.sum() for each in counts]))
    return axis, orders[axis], counts[axis]


def _pairs(rows: NDArray[np.int64], counts: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Row i paired with each of the ``counts[i]`` rows after it."""
    first = np.repeat(rows, counts)
    nth = np.arange(len(first)) - np.repeat(np.cumsum(counts) - counts, counts)
    return first, first + 1 + nth


def _parts(edge: Plane, other: Plane, away: Plane) -> NDArray[np.float64]:
    """Negative where the line of an edge parts the ends of another, 0 where one of them lies on it.

    The other edge begins at ``away``, as seen from where the first begins.
    """
    least = ON_LINE * np.abs(edge)
    begin = (edge.conj() * away).imag
    end = begin + (edge.conj() * other).imag
    return np.sign(begin) * (np.abs(begin) > least) * np.sign(end) * (np.abs(end) > least)
