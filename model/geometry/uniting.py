"""A whole outline united with what is seen of the cap, which no ellipse follows exactly."""

from __future__ import annotations

import shapely
from shapely import Geometry

from fairyring.model.geometry.shapes import Outline, Points, part_of_points, points_of_part

LEAST_AREA = 1e-3
"""px²; a piece with less is none."""


def united_with(whole: list[float], visible: Outline) -> Outline:
    """The polygon ``whole`` and the parts of a checked outline as one outline, without holes.

    Where the polygon covers the parts it comes back as it is; else vertices of both are kept, and new ones
    lie where they cross.
    """
    polygon: Geometry = shapely.Polygon(points_of_part(whole))
    united = polygon
    for part in visible:
        piece = _polygon_of(part)
        if not shapely.covers(polygon, piece):
            united = shapely.union(united, piece)
    if united is polygon:
        return [whole]
    return [part_of_points(rim) for rim in _rims_of(united)]


def _polygon_of(part: list[float]) -> Geometry:
    polygon: Geometry = shapely.Polygon(points_of_part(part))
    # Even-odd, as everywhere: a bridge to a hole is a pair of edges that lie on each other.
    return polygon if shapely.is_valid(polygon) else shapely.make_valid(polygon)


def _rims_of(united: Geometry) -> list[Points]:
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
