"""Whole outlines united with what is seen of their caps, which no ellipse follows exactly.

All caps of an image at once: most of the work is shapely's, and it does that without holding up others.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from fairyring.model.geometry.rings import Rings, parts_of, rings_of
from fairyring.model.geometry.shapes import Outline, Points, part_of_points

LEAST_AREA = 1e-3
"""px²; a piece with less is none."""

Geometries = NDArray[Any]


def united_with(whole: list[float], visible: Outline) -> Outline:
    """The polygon ``whole`` and the parts of a checked outline as one outline; see ``united``."""
    (found,) = united(rings_of([whole]), rings_of(visible), np.zeros(len(visible), np.intp))
    return found


def united(wholes: Rings, seen: Rings, owners: NDArray[np.intp]) -> list[Outline]:
    """Each of k polygons united with the parts that are seen of its cap: k outlines without holes.

    Where the polygon covers the parts it comes back as it is; else vertices of both are kept, and new ones
    lie where they cross.

    Args:
        wholes: the k polygons.
        seen: m parts of checked outlines.
        owners: (m,) the polygon that each part is seen of.
    """
    polygons, pieces = _polygons(wholes), _polygons(seen)
    # Even-odd, as everywhere: a bridge to a hole is a pair of edges that lie on each other.
    tangled = ~shapely.is_valid(pieces)
    pieces[tangled] = shapely.make_valid(pieces[tangled])
    outside = np.flatnonzero(~shapely.covers(polygons[owners], pieces))
    grown, changed = polygons.copy(), np.zeros(len(polygons), np.bool_)
    changed[owners[outside]] = True
    while len(outside):
        # One part of each cap at a time.
        _, firsts = np.unique(owners[outside], return_index=True)
        now = outside[firsts]
        grown[owners[now]] = shapely.union(grown[owners[now]], pieces[now])
        outside = np.delete(outside, firsts)
    return _outlines(grown, as_they_were=parts_of(wholes), changed=changed)


def _polygons(rings: Rings) -> Geometries:
    lines = shapely.linearrings(rings.points, indices=rings.owners)
    return np.asarray(shapely.polygons(lines))


def _outlines(
    grown: Geometries, *, as_they_were: Sequence[list[float]], changed: NDArray[np.bool_]
) -> list[Outline]:
    found: list[Outline] = [[part] for part in as_they_were]
    simple = changed & (shapely.get_type_id(grown) == shapely.GeometryType.POLYGON)
    rims = parts_of(_open_rings(shapely.get_exterior_ring(grown[simple])))
    for nth, rim in zip(np.flatnonzero(simple).tolist(), rims, strict=True):
        found[nth] = [rim]
    for nth in np.flatnonzero(changed & ~simple).tolist():
        found[nth] = [part_of_points(rim) for rim in _rims_of(grown[nth])]
    return found


def _open_rings(rings: Geometries) -> Rings:
    """The vertices of rings, without the last of each, which repeats the first."""
    points, owners = shapely.get_coordinates(rings, return_index=True)
    counts = np.bincount(owners, minlength=len(rings))
    return Rings(np.delete(points, np.cumsum(counts) - 1, axis=0), counts - 1)


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
