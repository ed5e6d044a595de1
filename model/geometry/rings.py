"""Many closed polygons as one array, for what is worked out for all of them at once.

The functions of `shapes` do the same for one polygon; for the hundreds of an image, calling those takes ten
times as long as the arithmetic.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import Circle, Outline, Points, Shape

Floats = NDArray[np.float64]
Integers = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Rings:
    """k closed polygons of one vertex or more; the last vertex of each joins its first."""

    points: Points
    """(n, 2) the vertices, polygon after polygon."""
    counts: Integers
    """(k,) how many vertices each has."""

    @property
    def starts(self) -> Integers:
        """(k,) the index of the first vertex of each."""
        return np.cumsum(self.counts) - self.counts

    @property
    def owners(self) -> Integers:
        """(n,) the polygon of each vertex."""
        return np.repeat(np.arange(len(self.counts)), self.counts)


@dataclass(frozen=True, eq=False)
class Outlines:
    """k outlines of one part or more."""

    rings: Rings
    """The parts of all, outline after outline."""
    counts: Integers
    """(k,) how many parts each has."""

    @property
    def starts(self) -> Integers:
        """(k,) the index of the first part of each."""
        return np.cumsum(self.counts) - self.counts

    @property
    def owners(self) -> Integers:
        """The outline of each part."""
        return np.repeat(np.arange(len(self.counts)), self.counts)


def rings_of(parts: Sequence[list[float]]) -> Rings:
    """Parts ``[x0, y0, x1, y1, …]`` as one array."""
    counts = np.fromiter((len(part) // 2 for part in parts), np.intp, len(parts))
    flat = np.fromiter(chain.from_iterable(parts), np.float64, 2 * int(counts.sum()))
    return Rings(flat.reshape(-1, 2), counts)


def parts_of(rings: Rings) -> list[list[float]]:
    """The polygons as parts."""
    flat, ends = rings.points.ravel().tolist(), np.cumsum(2 * rings.counts).tolist()
    return [flat[start:end] for start, end in zip([0, *ends], ends, strict=False)]


def outlines_of(outlines: Sequence[Outline]) -> Outlines:
    """Outlines as one array."""
    counts = np.fromiter(map(len, outlines), np.intp, len(outlines))
    return Outlines(rings_of(list(chain.from_iterable(outlines))), counts)


def lists_of(outlines: Outlines) -> list[Outline]:
    """The outlines as lists of parts."""
    parts, ends = parts_of(outlines.rings), np.cumsum(outlines.counts).tolist()
    return [parts[start:end] for start, end in zip([0, *ends], ends, strict=False)]


def picked(rings: Rings, which: Integers) -> Rings:
    """The polygons of these indices, in the order of these."""
    counts = rings.counts[which]
    return Rings(rings.points.take(_ranges(rings.starts[which], counts), axis=0), counts)


def picked_outlines(outlines: Outlines, which: Integers) -> Outlines:
    """The outlines of these indices, in the order of these."""
    counts = outlines.counts[which]
    return Outlines(picked(outlines.rings, _ranges(outlines.starts[which], counts)), counts)


def _ranges(starts: Integers, counts: Integers) -> Integers:
    """The indices from each start on, as many as its count, range after range."""
    return np.arange(int(counts.sum())) + np.repeat(starts - (np.cumsum(counts) - counts), counts)


def following_of(rings: Rings) -> Integers:
    """(n,) the index of the vertex after each."""
    following = np.arange(1, len(rings.points) + 1)
    following[np.cumsum(rings.counts) - 1] = rings.starts
    return following


def areas_of(rings: Rings) -> Floats:
    """(k,) areas in px²."""
    if not len(rings.counts):
        return np.empty(0)
    starts, following = rings.starts, following_of(rings)
    # From each polygon's first vertex, so that nothing is lost far from the image's corner.
    x, y = (rings.points - np.repeat(rings.points[starts], rings.counts, axis=0)).T
    return np.abs(np.add.reduceat(x * y[following] - y * x[following], starts)) / 2


def means_of(rings: Rings) -> Points:
    """(k, 2) the means of the vertices of each."""
    return np.add.reduceat(rings.points, rings.starts) / rings.counts[:, None]


def bounds_of(rings: Rings) -> tuple[Points, Points]:
    """(k, 2) the least and the greatest x, y of each."""
    if not len(rings.counts):
        return np.empty((0, 2)), np.empty((0, 2))
    starts = rings.starts
    return np.minimum.reduceat(rings.points, starts), np.maximum.reduceat(rings.points, starts)


def rings_of_shapes(shapes: Sequence[Shape], *, chord_error: float = 0.1) -> Rings:
    """Circles and ellipses as polygons, as `polygon_of_shape` makes them of one."""
    cx, cy, a, b, degrees = np.array(
        [
            (each.cx, each.cy, each.r, each.r, 0.0)
            if isinstance(each, Circle)
            else (each.cx, each.cy, each.a, each.b, each.theta_deg)
            for each in shapes
        ],
        np.float64,
    ).reshape(-1, 5).T  # fmt: skip
    half_angles = np.arccos(np.maximum(0.0, 1.0 - chord_error / np.maximum(a, chord_error)))
    counts = np.maximum(12, 2 * np.ceil(math.pi / half_angles / 2)).astype(np.intp)
    rings = Rings(np.empty((int(counts.sum()), 2)), counts)
    owners = rings.owners
    t = (np.arange(len(owners)) - rings.starts[owners]) * (2 * math.pi / counts)[owners]
    theta = np.radians(degrees)
    along, across = a[owners] * np.cos(t), b[owners] * np.sin(t)
    cos, sin = np.cos(theta)[owners], np.sin(theta)[owners]
    rings.points[:, 0] = cx[owners] + along * cos - across * sin
    rings.points[:, 1] = cy[owners] + along * sin + across * cos
    return rings
