"""Polygons with holes as one closed polygon each: every hole is reached over a bridge, run both ways."""

from __future__ import annotations

import numpy as np

from fairyring.model.geometry.shapes import Points, without_repeats


def join_holes(outer: Points, holes: list[Points]) -> Points:
    """One closed polygon (n, 2) of an outer polygon and the holes inside it, in O(n) steps a hole.

    A bridge runs level to the left from a hole's leftmost vertex to the first edge that it meets. The hole
    that reaches furthest left goes first, so that this edge is one of the polygon already joined.
    """
    joined = outer
    for hole in sorted(holes, key=lambda points: points[:, 0].min()):
        at_hole = int(hole[:, 0].argmin())
        joined, at_joined = _with_bridgehead(joined, hole[at_hole])
        joined = np.concatenate(
            [
                joined[: at_joined + 1],
                np.roll(hole, -at_hole, axis=0),
                hole[at_hole : at_hole + 1],
                joined[at_joined:],
            ]
        )
    # The bridge to a hole that touches what it is joined to has no length.
    return without_repeats(joined)


def _with_bridgehead(polygon: Points, point: Points) -> tuple[Points, int]:
    """The polygon with a vertex where a ray from ``point`` (2,) to the left first meets it, and its index.

    Where nothing lies to the left, as rounding may have moved a hole beyond the rim, its nearest vertex.
    """
    starts, ends = polygon, np.roll(polygon, -1, axis=0)
    x, y = point
    met = np.flatnonzero((np.minimum(starts, ends)[:, 1] <= y) & (y <= np.maximum(starts, ends)[:, 1]))
    (x0, y0), (x1, y1) = starts[met].T, ends[met].T
    level = y0 == y1
    share = np.where(level, 0.0, (y - y0) / np.where(level, 1.0, y1 - y0))
    # A level edge is first met at its right end.
    feet = np.where(level, np.maximum(x0, x1), x0 + share * (x1 - x0))
    feet[feet > x] = -np.inf
    if not len(feet) or np.isneginf(feet).all():
        return polygon, int(np.hypot(*(polygon - point).T).argmin())
    nearest = int(feet.argmax())
    edge, foot = int(met[nearest]), np.array([feet[nearest], y])
    for index in (edge, (edge + 1) % len(polygon)):
        if np.array_equal(polygon[index], foot):
            return polygon, index
    return np.insert(polygon, edge + 1, foot, axis=0), edge + 1
