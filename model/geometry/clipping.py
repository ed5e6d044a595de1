"""Outlines cut where the image ends."""

from __future__ import annotations

from collections.abc import Iterator

from fairyring.model.geometry.self_contact import self_contact
from fairyring.model.geometry.shapes import (
    GeometryError,
    Outline,
    Points,
    part_of_points,
    points_of_part,
    signed_area,
    without_repeats,
)
from fairyring.model.geometry.winding import covered_parts

LEAST_AREA = 1e-3
"""px²; a piece with less is none."""

Vertex = tuple[float, float]


def clipped_outline(outline: Outline, *, width: int, height: int) -> Outline:
    """What of a checked outline lies in an image of this size; GeometryError where nothing does.

    Vertices inside stay where they are, new ones lie on the border. A part that leaves the image and comes
    back may become several.
    """
    if all(_is_inside(part, width, height) for part in outline):
        return outline
    inside = [
        part_of_points(piece)
        for part in outline
        for piece in _pieces(part, width, height)
        if len(piece) > 2 and abs(signed_area(piece)) >= LEAST_AREA
    ]
    if not inside:
        raise GeometryError("The outline lies outside the image.")
    return inside


def _is_inside(part: list[float], width: int, height: int) -> bool:
    return min(part) >= 0 and max(part[0::2]) <= width and max(part[1::2]) <= height


def _pieces(part: list[float], width: int, height: int) -> list[Points]:
    """By one side of the image after the other, as Sutherland and Hodgman do."""
    if _is_inside(part, width, height):
        return [points_of_part(part)]
    vertices = list(zip(part[0::2], part[1::2], strict=True))
    for axis, bound, inwards in ((0, 0, 1), (0, width, -1), (1, 0, 1), (1, height, -1)):
        vertices = list(_cut(vertices, axis=axis, bound=float(bound), inwards=inwards))
    points = without_repeats(points_of_part([figure for vertex in vertices for figure in vertex]))
    if len(points) < 3 or not self_contact(points).touches:
        return [points]
    # The pieces of a polygon that left the image more than once hang together along the border.
    return covered_parts(points, rule="evenodd")


def _cut(vertices: list[Vertex], *, axis: int, bound: float, inwards: int) -> Iterator[Vertex]:
    """The vertices of what lies on one side of a line, those on the line itself included."""
    depths = [inwards * (vertex[axis] - bound) for vertex in vertices]
    for here, there, depth, next_depth in zip(
        vertices, vertices[1:] + vertices[:1], depths, depths[1:] + depths[:1], strict=True
    ):
        if depth >= 0:
            yield here
        if (depth < 0) != (next_depth < 0):
            share = depth / (depth - next_depth)
            other = here[1 - axis] + share * (there[1 - axis] - here[1 - axis])
            yield (bound, other) if axis == 0 else (other, bound)
