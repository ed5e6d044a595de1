"""Polygons that a point inside sees all around: every ray from it meets the rim once.

Two of these, seen from the same point, are united ray by ray, by arithmetic alone: at every angle the rim
that lies further out is the rim of both together. Points are complex numbers here, x + iy.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.rings import Floats, Integers, Rings, following_of
from fairyring.model.geometry.shapes import Points

Complex = NDArray[np.complex128]
Flags = NDArray[np.bool_]
ON_THE_RIM = 1e-9
"""px²; a corner that spans no more with an edge lies on it. With four decimals it is 0, or 1e-8 and more."""


def turned_forwards(rings: Rings) -> Rings:
    """The polygons, those turned round whose vertices run from +y towards +x."""
    first = np.repeat(rings.starts, rings.counts)
    points = _complex(rings.points)
    points = points - points[first]
    backwards = np.add.reduceat(_cross(points, points[following_of(rings)]), rings.starts) < 0
    if not backwards.any():
        return rings
    nth = np.arange(len(points))
    mirrored = 2 * first + np.repeat(rings.counts, rings.counts) - 1 - nth
    return Rings(rings.points[np.where(np.repeat(backwards, rings.counts), mirrored, nth)], rings.counts)


def are_seen_around(rings: Rings, centres: Points) -> Flags:
    """(k,) whether each polygon, turned forwards, is seen all around from its point of (k, 2)."""
    points = _complex(rings.points) - np.repeat(_complex(centres), rings.counts)
    following = following_of(rings)
    angles = np.angle(points)
    rounds = np.add.reduceat((angles[following] < angles).astype(np.intp), rings.starts)
    turns = np.minimum.reduceat(_cross(points, points[following]), rings.starts)
    return (turns > ON_THE_RIM) & (rounds == 1)


def united_around(first: Rings, second: Rings, centres: Points) -> tuple[Rings, Flags]:
    """Each of k polygons united with one of k others, both seen all around from the same point.

    Vertices of either that the other does not cover are kept as they are, and new ones lie where rims cross;
    they run from the angle -180° on.

    Returns:
        the k polygons, and (k,) whether the second reached out of the first anywhere.
    """
    both = _seen(first, second, centres)
    start, end = both.edges_of(first, of_second=False)
    other_start, other_end = both.edges_of(second, of_second=True)
    across = np.where(both.is_second, start, other_start)
    inwards = _cross(np.where(both.is_second, end, other_end) - across, both.points - across)
    inwards[np.abs(inwards) <= ON_THE_RIM] = 0
    lead = np.where(both.is_second, inwards, -inwards)
    is_kept, is_crossing = inwards <= 0, lead * lead[following_of(both.rings)] < 0
    kept, crossing = np.flatnonzero(is_kept), np.flatnonzero(is_crossing)
    many = is_kept.astype(np.intp) + is_crossing
    before = np.cumsum(many) - many
    rims = np.empty(int(many.sum()), np.complex128)
    rims[before[kept]] = _complex(both.rings.points)[kept]
    rims[(before + is_kept)[crossing]] = both.centres[crossing] + _crossings(
        start[crossing], end[crossing], other_start[crossing], other_end[crossing]
    )
    united = _without_repeats(rims, np.add.reduceat(many, both.rings.starts))
    return united, np.minimum.reduceat(lead, both.rings.starts) < 0


@dataclass(frozen=True, eq=False)
class _Both:
    """The n vertices of two polygons for each of k points, by the angle at which the point sees them."""

    rings: Rings
    points: Complex
    """(n,) the vertices as the point sees them."""
    centres: Complex
    """(n,) the point of each vertex."""
    is_second: Flags
    """(n,)"""

    def edges_of(self, rings: Rings, *, of_second: bool) -> tuple[Complex, Complex]:
        """Start and end (n,) of the edge of the first or second polygon at the angle of each vertex."""
        mine = self.is_second == of_second
        starts = np.repeat(rings.starts, self.rings.counts)
        ends = starts + np.repeat(rings.counts, self.rings.counts)
        before = np.cumsum(mine) - 1
        before = np.where(before < starts, ends - 1, before)
        after = np.where(before + 1 == ends, starts, before + 1)
        points = self.points[mine]
        return points[before], points[after]


def _seen(first: Rings, second: Rings, centres: Points) -> _Both:
    owners = np.concatenate([first.owners, second.owners])
    as_given = np.concatenate([first.points, second.points])
    centres_of_all = _complex(centres)[owners]
    points = _complex(as_given) - centres_of_all
    # Both run in this order for the most part, which a stable sort makes use of.
    order = np.argsort(owners * 8.0 + np.angle(points), kind="stable")
    rings = Rings(as_given[order], first.counts + second.counts)
    return _Both(rings, points[order], centres_of_all[order], order >= len(first.points))


def _complex(points: Points) -> Complex:
    return np.ascontiguousarray(points).view(np.complex128)[:, 0]


def _cross(left: Complex, right: Complex) -> Floats:
    return left.real * right.imag - left.imag * right.real


def _crossings(start: Complex, end: Complex, other_start: Complex, other_end: Complex) -> Complex:
    """Where the line through each edge crosses that through another."""
    along, other_along = end - start, other_end - other_start
    return start + _cross(other_start - start, other_along) / _cross(along, other_along) * along


def _without_repeats(points: Complex, counts: Integers) -> Rings:
    rings = Rings(points.view(np.float64).reshape(-1, 2), counts)
    repeats = points == points[following_of(rings)]
    if not repeats.any():
        return rings
    return Rings(rings.points[~repeats], counts - np.add.reduceat(repeats.astype(np.intp), rings.starts))
