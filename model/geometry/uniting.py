"""Whole outlines united with what is seen of their caps, which no ellipse follows exactly.

All caps of an image at once. Most are seen all around from their centre, which makes it a matter of
arithmetic; the others, and those in pieces, are shapely's.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from fairyring.model.geometry.rings import (
    Integers,
    Outlines,
    Rings,
    lists_of,
    means_of,
    outlines_of,
    picked,
    picked_outlines,
    rings_of,
)
from fairyring.model.geometry.seen_around import are_seen_around, turned_forwards, united_around
from fairyring.model.geometry.shapes import Outline, Points, part_of_points

LEAST_AREA = 1e-3
"""px²; a piece with less is none."""

Geometries = NDArray[Any]


def united_with(whole: list[float], visible: Outline) -> Outline:
    """The polygon ``whole`` and the parts of a checked outline as one outline; see ``united``."""
    (found,) = lists_of(united(rings_of([whole]), outlines_of([visible])))
    return found


def united(wholes: Rings, seen: Outlines) -> Outlines:
    """Each of k polygons united with what is seen of its cap: k outlines without holes.

    Where the polygon covers that it comes back as it is; else vertices of both are kept, and new ones lie
    where they cross.

    Args:
        wholes: the k polygons.
        seen: k checked outlines.
    """
    if not len(wholes.counts):
        return seen
    single = np.flatnonzero(seen.counts == 1)
    grown, easy = _grown_around(wholes, single, picked(seen.rings, seen.starts[single]))
    others = np.setdiff1d(np.arange(len(wholes.counts)), easy)
    if not len(others):
        return grown
    return _replaced(grown, others, _by_shapely(picked(wholes, others), picked_outlines(seen, others)))


def _grown_around(wholes: Rings, numbers: Integers, parts: Rings) -> tuple[Outlines, Integers]:
    """The polygons, those of these numbers united with a part each where arithmetic does; and which."""
    grown = Outlines(wholes, np.ones(len(wholes.counts), np.intp))
    if not len(numbers):
        return grown, numbers
    forwards, parts = turned_forwards(picked(wholes, numbers)), turned_forwards(parts)
    centres = means_of(forwards)
    around = np.flatnonzero(are_seen_around(forwards, centres) & are_seen_around(parts, centres))
    if not len(around):
        return grown, around
    found, reached = united_around(picked(forwards, around), picked(parts, around), centres[around])
    changed = np.flatnonzero(reached)
    rims = Outlines(picked(found, changed), np.ones(len(changed), np.intp))
    return _replaced(grown, numbers[around[changed]], rims), numbers[around]


def _replaced(outlines: Outlines, which: Integers, by: Outlines) -> Outlines:
    """The outlines, but others in place of those of these indices."""
    rings, others = outlines.rings, by.rings
    points = np.concatenate([rings.points, others.points])
    counts = np.concatenate([rings.counts, others.counts])
    order = np.arange(len(outlines.counts))
    order[which] = len(order) + np.arange(len(which))
    both = Outlines(Rings(points, counts), np.concatenate([outlines.counts, by.counts]))
    return picked_outlines(both, order)


def _by_shapely(wholes: Rings, seen: Outlines) -> Outlines:
    polygons, pieces = _polygons(wholes), _polygons(seen.rings)
    # Even-odd, as everywhere: a bridge to a hole is a pair of edges that lie on each other.
    tangled = ~shapely.is_valid(pieces)
    pieces[tangled] = shapely.make_valid(pieces[tangled])
    owners = seen.owners
    outside = np.flatnonzero(~shapely.covers(polygons[owners], pieces))
    changed = np.unique(owners[outside])
    while len(outside):
        # One part of each cap at a time.
        _, firsts = np.unique(owners[outside], return_index=True)
        now = outside[firsts]
        polygons[owners[now]] = shapely.union(polygons[owners[now]], pieces[now])
        outside = np.delete(outside, firsts)
    as_they_were = Outlines(wholes, np.ones(len(wholes.counts), np.intp))
    found = outlines_of([[part_of_points(rim) for rim in _rims_of(each)] for each in polygons[changed]])
    return _replaced(as_they_were, changed, found)


def _polygons(rings: Rings) -> Geometries:
    lines = shapely.linearrings(rings.points, indices=rings.owners)
    return np.asarray(shapely.polygons(lines))


def _rims_of(united: Any) -> list[Points]:
    """The vertices of the outer rings of its pieces, but of those that others enclose."""
    rims = [
        shapely.get_coordinates(shapely.get_exterior_ring(piece))
        for piece in shapely.get_parts(united)
        if shapely.area(piece) >= LEAST_AREA
    ]
    if len(rims) > 1:
        filled = shapely.get_parts(shapely.union_all([shapely.Polygon(rim) for rim in rims]))
        rims = [shapely.get_coordinates(shapely.get_exterior_ring(piece)) for piece in filled]
    return [rim[:-1] for rim in rims]
