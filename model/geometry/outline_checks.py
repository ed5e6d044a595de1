"""Which outlines and marks are fit to be stored, and how outlines that are nearly so are put right.

Everything here comes from a file or a browser. Whatever it is, the answer takes well under a second and
little memory: how much there is to do is counted before it is done, and too much is refused.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from operator import sub
from typing import Any

import numpy as np
from msgspec.structs import astuple

from fairyring.model.geometry.self_contact import (
    MOST_CROSSINGS,
    MOST_PAIRS,
    Contact,
    area_if_plainly_simple,
    self_contact,
)
from fairyring.model.geometry.shapes import (
    Centre,
    Circle,
    GeometryError,
    Mark,
    Outline,
    Points,
    Polygon,
    canonical_ellipse,
    part_of_points,
    points_of_part,
    signed_area,
    without_repeats,
)
from fairyring.model.geometry.winding import FillRule, covered_parts

MAX_PARTS = 500
MAX_POINTS = 10_000
"""Most points of one part."""
MAX_POINTS_IN_ALL = 20_000
MAX_RIM = 1_000_000
"""Longest rim of all parts together, pixels: the rasteriser's time and memory go with it."""
REACH = 4
"""How many image widths and heights a point may lie outside the image."""
SLACK = 0.02
"""Share of its radius by which a circle or an ellipse may miss the image."""
LEAST_AREA = 1e-3
"""A polygon of less area than this, px², counts as having none."""
LEAST_MARK = 1.0
"""A marked polygon of less area than this, px², marks no cap."""
LEAST_RADIUS = 0.25
"""Nor does a circle or an ellipse with a smaller radius, pixels."""
SPECK = 0.005
"""Share of what a polygon that crosses itself covers, up to which a lobe or a hole is the pen's slip."""
ROUNDING = 1e-6
"""Areas that differ by less than this, px², count as the same."""

NUMBERS = {int, float}
"""The types a coordinate may have; bool, which Python counts among the integers, is not one."""


def check_outline(
    outline: Any, *, width: int, height: int, left_out: Callable[[str], object] | None = None
) -> Outline:
    """The outline of a cap in an image of this size, as floats, fit to be stored.

    Repeated vertices go. A part that crosses itself is replaced by all that it runs around, in one part or
    several, without specks; it changes only there: other vertices stay. One that merely touches itself, as on
    a bridge to a hole, is left as it is, unless parts of it cover the same twice.

    ``left_out`` hears which of several parts cannot be used; without it, or where no other is left, that is
    an error. Raises GeometryError for what is not a list of flat lists of finite numbers; for parts of fewer
    than three points, without area, further out than REACH images or outside the image altogether; for more
    than MAX_PARTS parts, too many points, a rim longer than MAX_RIM, or a tangle.
    """
    if not isinstance(outline, list) or not outline:
        raise GeometryError("The outline has no parts.")
    if len(outline) > MAX_PARTS:
        raise GeometryError(f"The outline has {len(outline)} parts; {MAX_PARTS} are allowed.")
    if sum(len(part) for part in outline if isinstance(part, list)) > 2 * MAX_POINTS_IN_ALL:
        raise GeometryError(f"The outline has more than {MAX_POINTS_IN_ALL} points.")
    checked: Outline = []
    reasons: list[str] = []
    effort = _Effort()
    for number, part in enumerate(outline, start=1):
        try:
            checked += _check_part(part, width, height, effort)
        except GeometryError as error:
            if left_out is None or len(outline) == 1:
                raise
            reasons.append(f"Part {number} was left out: {error}")
    if not checked:
        raise GeometryError(reasons[0])
    if left_out is not None:
        for reason in reasons:
            left_out(reason)
    # No edge within reach is longer than this, and the rims of most outlines need no adding up.
    longest_edge = (2 * REACH + 1) * (width + height)
    if sum(map(len, checked)) / 2 * longest_edge > MAX_RIM:
        _check_rim(sum(map(_rim, checked)))
    return checked


def usable_outline(outline: Any, *, width: int, height: int) -> Outline:
    """As ``check_outline``; an outline that cannot be used becomes one without parts."""
    try:
        return check_outline(outline, width=width, height=height)
    except GeometryError:
        return []


def check_mark(mark: Mark, *, width: int, height: int) -> Mark:
    """The mark, a polygon without repeated vertices.

    Raises GeometryError for what is not finite, has no size to speak of, is far larger than the image or
    lies beside it, and for a polygon that crosses itself.
    """
    if isinstance(mark, Polygon):
        points = _vertices(mark.points, width, height)
        if self_contact(points).crossings:
            raise GeometryError("The polygon crosses itself.")
        if abs(signed_area(points)) < LEAST_MARK:
            raise GeometryError("The polygon has no area.")
        _check_meets(*points.min(axis=0), *points.max(axis=0), width=width, height=height)
        return Polygon(part_of_points(points))
    figures = astuple(mark)
    if any(type(figure) not in (int, float) or not math.isfinite(figure) for figure in figures):
        raise GeometryError("A centre, a radius or an angle is not a finite number.")
    check_centre((mark.cx, mark.cy), width=width, height=height)
    radii = (mark.r,) if isinstance(mark, Circle) else (mark.a, mark.b)
    if min(radii) < LEAST_RADIUS or max(radii) > REACH * max(width, height):
        raise GeometryError(f"A radius must be at least {LEAST_RADIUS} px and not many times the image.")
    # No ellipse follows a cap exactly: of one at the image's border only what it leaves out may be in sight.
    reach = (1 + SLACK) * max(radii)
    left, top, right, bottom = mark.cx - reach, mark.cy - reach, mark.cx + reach, mark.cy + reach
    _check_meets(left, top, right, bottom, width=width, height=height)
    return mark if isinstance(mark, Circle) else canonical_ellipse(*figures)


def check_centre(centre: Centre, *, width: int, height: int) -> Centre:
    """The finite centre of a cap, perhaps outside the image; GeometryError where it lies far outside."""
    x, y = centre
    if abs(x - width / 2) > (REACH + 0.5) * width or abs(y - height / 2) > (REACH + 0.5) * height:
        raise GeometryError(f"A centre lies far outside the image of {width} × {height} pixels.")
    return centre


def _check_meets(left: float, top: float, right: float, bottom: float, *, width: int, height: int) -> None:
    """A mark may go on beyond the image, but what it is of must be on it."""
    if right <= 0 or bottom <= 0 or left >= width or top >= height:
        raise GeometryError(f"The mark lies beside the image of {width} × {height} pixels.")


@dataclass
class _Effort:
    """How much checking the parts of an outline has taken so far."""

    pairs: int = 0
    """Pairs of edges that were compared."""
    crossings: int = 0
    rim: float = 0
    """Pixels, of the parts that had to be looked at closely."""


def _check_part(part: Any, width: int, height: int, effort: _Effort) -> Outline:
    if _is_plainly_good(part, width, height):
        return [list(map(float, part))]
    points = _vertices(part, width, height)
    effort.rim += _rim(part_of_points(points))
    _check_rim(effort.rim)
    contact = self_contact(points, most_pairs=MOST_PAIRS - effort.pairs)
    effort.pairs += contact.pairs
    effort.crossings += contact.crossings
    if effort.crossings > MOST_CROSSINGS:
        raise GeometryError(f"The outline crosses itself more than {MOST_CROSSINGS} times; draw it anew.")
    return _in_image(_untangled(points, contact), width, height)


def _in_image(parts: list[Points], width: int, height: int) -> Outline:
    """The parts whose boxes meet the image."""
    if max((abs(signed_area(points)) for points in parts), default=0) < LEAST_AREA:
        raise GeometryError("A polygon has no area.")
    inside = [
        part_of_points(points)
        for points in parts
        if (points.min(axis=0) < (width, height)).all() and (points.max(axis=0) > 0).all()
    ]
    if not inside:
        raise GeometryError("A polygon lies outside the image.")
    return inside


def _untangled(points: Points, contact: Contact) -> list[Points]:
    """The parts that a polygon covers: itself, where it only touches itself and covers nothing twice."""
    if contact.crossings:
        return covered_parts(points, rule="nonzero", speck=SPECK)
    if not contact.touches:
        return [points]
    rule: FillRule = "evenodd" if _has_bridge(points) else "nonzero"
    parts = covered_parts(points, rule=rule)
    covered = sum(abs(signed_area(part)) for part in parts)
    # A figure of eight's own area comes out too small, that of a line run through twice too large.
    unchanged = abs(covered - abs(signed_area(points))) <= ROUNDING * (1 + covered)
    return [points] if unchanged else parts


def _has_bridge(points: Points) -> bool:
    """Whether an edge is run through in both directions.

    Such a bridge leads to a hole even where the hole's vertices run the same way round as the rim's.
    """
    vertices = list(map(tuple, points.tolist()))
    edges = set(zip(vertices, vertices[1:] + vertices[:1], strict=True))
    return any((end, start) in edges for start, end in edges)


def _is_plainly_good(part: Any, width: int, height: int) -> bool:
    """Whether a part is of the usual kind, near the image and all in sight of its middle: a quick way out."""
    if not isinstance(part, list) or len(part) % 2 or not 6 <= len(part) <= 2 * MAX_POINTS:
        return False
    if not set(map(type, part)) <= NUMBERS:
        return False
    xs, ys = part[::2], part[1::2]
    near = -width <= min(xs) < width and -height <= min(ys) < height
    near = near and 0 < max(xs) <= 2 * width and 0 < max(ys) <= 2 * height
    # One NaN makes the sum NaN, wherever it hid from the comparisons.
    return near and math.isfinite(sum(part)) and area_if_plainly_simple(xs, ys) >= LEAST_AREA


def _vertices(part: Any, width: int, height: int) -> Points:
    """(n ≥ 3, 2) vertices of a flat list from outside, without repeated neighbours."""
    if not isinstance(part, list) or len(part) % 2:
        raise GeometryError("A polygon must be a flat list of x and y in turn.")
    if len(part) > 2 * MAX_POINTS:
        raise GeometryError(f"A polygon has {len(part) // 2} points; {MAX_POINTS} are allowed.")
    if not set(map(type, part)) <= NUMBERS:
        raise GeometryError("A polygon's coordinates must be numbers.")
    try:
        points = points_of_part(part)
    except OverflowError:
        raise GeometryError("A polygon's coordinates must be finite numbers.") from None
    points = without_repeats(points)
    if len(points) < 3:
        raise GeometryError("A polygon needs at least three points.")
    _check_reach(points, width, height)
    return points


def _check_reach(points: Points, width: int, height: int) -> None:
    if not np.isfinite(points).all():
        raise GeometryError("A polygon's coordinates must be finite numbers.")
    size = np.array([width, height])
    if (np.abs(points - size / 2) > (REACH + 0.5) * size).any():
        raise GeometryError(f"A point lies far outside the image of {width} × {height} pixels.")


def _rim(part: list[float]) -> float:
    """Length of a part in pixels, along x and y added up."""
    return sum(map(abs, map(sub, part, part[-2:] + part[:-2])))


def _check_rim(pixels: float) -> None:
    if pixels > MAX_RIM:
        raise GeometryError(f"The outline is longer than {MAX_RIM} pixels; draw it with fewer turns.")
