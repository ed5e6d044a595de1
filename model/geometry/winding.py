"""What a closed polygon that runs through itself covers."""

from __future__ import annotations

from typing import Literal

import numpy as np
import shapely
from numpy.typing import NDArray

from fairyring.model.geometry.bridges import join_holes
from fairyring.model.geometry.shapes import Points

FillRule = Literal["nonzero", "evenodd"]
COMPARED_AT_ONCE = 1 << 20


def covered_parts(points: Points, *, rule: FillRule, speck: float = 0) -> list[Points]:
    """The parts of what a closed polygon (n, 2) covers, none of which crosses itself.

    ``nonzero`` is all that it runs around, however often: a stroke that runs on beyond its start covers the
    same twice. ``evenodd`` is what lies inside an odd number of times. Lobes and holes of at most ``speck``
    times the whole are left out. Vertices stay where they are; new ones lie where the polygon crosses itself.
    Time goes with the number of crossings times that of vertices.
    """
    noded = shapely.unary_union(shapely.linearrings(points))
    faces = shapely.get_parts(shapely.polygonize([noded]))
    turns = winding_numbers(shapely.get_coordinates(shapely.point_on_surface(faces)), points)
    covered = turns % 2 == 1 if rule == "evenodd" else turns != 0
    whole = _united(faces[covered])
    least = speck * shapely.area(whole)
    lobes = [lobe for lobe in shapely.get_parts(whole) if shapely.area(lobe) > least]
    return [_part(lobe, least=least) for lobe in lobes]


def _united(faces: NDArray[np.object_]) -> shapely.Geometry:
    """All of some faces, which share edges and, but for rounding, nothing else."""
    try:
        return shapely.coverage_union_all(faces)
    except shapely.GEOSException:
        # Edges that nearly run along each other were rounded over each other.
        return shapely.union_all(faces)


def winding_numbers(places: Points, polygon: Points) -> NDArray[np.int64]:
    """(m,) how often a closed polygon (n, 2) runs, clockwise on the screen, around each place (m, 2)."""
    (x0, y0), (x1, y1) = polygon.T, np.roll(polygon, -1, axis=0).T
    turns = [np.zeros(0, np.int64)]
    for block in np.array_split(places, max(1, len(places) * len(polygon) // COMPARED_AT_ONCE)):
        x, y = block[:, :1], block[:, 1:]
        beside = np.sign((x1 - x0) * (y - y0) - (x - x0) * (y1 - y0))
        # The edges to the right of a place that pass its height, downwards and upwards.
        down, up = (y0 <= y) & (y < y1) & (beside > 0), (y1 <= y) & (y < y0) & (beside < 0)
        turns.append(np.count_nonzero(down, axis=1) - np.count_nonzero(up, axis=1))
    return np.concatenate(turns)


def _part(lobe: shapely.Geometry, *, least: float) -> Points:
    outer, *rings = shapely.get_rings(lobe)
    holes = [ring for ring in rings if shapely.area(shapely.polygons(ring)) > least]
    return join_holes(_vertices(outer), [_vertices(hole) for hole in holes])


def _vertices(ring: shapely.Geometry) -> Points:
    """(n, 2) of a ring, whose last vertex repeats its first in shapely."""
    return shapely.get_coordinates(ring)[:-1]
