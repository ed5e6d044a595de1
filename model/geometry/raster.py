"""Outlines, masks and run-length codes: every step between them goes through pycocotools' one rasteriser.

Outlines are those of ``model.geometry``. A mask is a uint8 array (height, width) of 0 and 1. An RLE is a
COCO dictionary ``{"size": [height, width], "counts": str}`` (compressed, ready for JSON).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import cv2
import numpy as np
from msgspec.structs import astuple
from numpy.typing import NDArray
from pycocotools import mask as pycocotools_mask

from fairyring.model.geometry.mask_tracing import (
    Component,
    Loop,
    components_of_mask,
    fit_polygon,
    join_holes,
    knots_of_loop,
)
from fairyring.model.geometry.rle import checked_counts, cut_of_counts
from fairyring.model.geometry.self_contact import area_if_plainly_simple, self_contact
from fairyring.model.geometry.shapes import (
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

Mask = NDArray[np.uint8]
Rle = dict[str, Any]

coco: Any = pycocotools_mask
"""Untyped: its stubs know neither lists of polygons nor counts as text."""

MAX_POINTS = 10_000
"""Of one part."""
REACH = 4
"""How many image widths and heights a point may lie outside the image."""
LEAST_AREA = 1e-3
"""px²; below this a polygon has none."""

NUMBERS = {int, float}
"""The types a coordinate may have; bool, which Python counts among the integers, is not one."""

TOLERANCE = 0.5
"""px; how far a smooth outline's vertices may first lie from the midpoints between its edges."""
ROUNDS = 4
"""Attempts at a smooth outline before the pixels' edges are taken."""
GRID = 25
"""Vertices a pixel of a smooth outline: no multiple of 1/25 lies where the rasteriser, which works in fifths,
rounds one way or the other by the last bit."""
SMALL = 8
"""Pixels up to which a component is drawn by its pixels' edges: a fit to so little is worth nothing."""


def rle_of_outline(outline: Outline, *, height: int, width: int) -> Rle:
    """The pixels whose centres the outline covers, its parts united.

    Coordinates must be finite and of a sane size, as ``check_outline`` leaves them. Raises GeometryError
    for a part of fewer than three points.
    """
    if not outline:
        return rle_of_mask(np.zeros((height, width), np.uint8))
    if any(len(part) < 6 for part in outline):
        raise GeometryError("A polygon needs at least three points.")
    codes = coco.frPyObjects(outline, height, width)
    return _as_text(codes[0] if len(codes) == 1 else coco.merge(codes, intersect=False))


def mask_of_outline(outline: Outline, *, height: int, width: int) -> Mask:
    """``rle_of_outline`` as a mask (height, width)."""
    return mask_of_rle(rle_of_outline(outline, height=height, width=width))


def rle_of_mask(mask: Mask) -> Rle:
    """Any array (height, width), non-zero where covered, as a compressed RLE."""
    return _as_text(coco.encode(np.asfortranarray(mask != 0, dtype=np.uint8)))


def mask_of_rle(rle: Rle) -> Mask:
    """An RLE of ours, or one that ``check_rle`` has passed, as a mask (height, width)."""
    return np.ascontiguousarray(coco.decode(rle))


def area_of_rle(rle: Rle) -> int:
    """Number of pixels."""
    return int(coco.area(rle))


def iou_matrix(first: Sequence[Rle], second: Sequence[Rle]) -> NDArray[np.float64]:
    """(n, m) intersection over union of every pair; 0 where both are empty.

    Raises GeometryError unless all have the same size.
    """
    return _overlaps(first, second, over_first=False)


def covered_matrix(first: Sequence[Rle], second: Sequence[Rle]) -> NDArray[np.float64]:
    """(n, m) share of each first mask's pixels that each second one covers; 0 of an empty mask.

    Raises GeometryError unless all have the same size.
    """
    return _overlaps(first, second, over_first=True)


def shares_inside(masks: Sequence[Rle], regions: Sequence[Rle]) -> NDArray[np.float64]:
    """(n,) share of each mask's pixels in any of the regions, all of one size; 0 of an empty mask."""
    if not regions:
        return np.zeros(len(masks))
    return covered_matrix(masks, [coco.merge(list(regions), intersect=False)])[:, 0]


def _overlaps(first: Sequence[Rle], second: Sequence[Rle], *, over_first: bool) -> NDArray[np.float64]:
    if len({tuple(rle["size"]) for rle in (*first, *second)}) > 1:
        raise GeometryError("Masks of different sizes cannot be compared.")
    if not first or not second:
        return np.zeros((len(first), len(second)))
    return np.asarray(coco.iou(list(first), list(second), [int(over_first)] * len(second)), dtype=np.float64)


def check_rle(rle: Any) -> Rle:
    """An RLE as a file holds it (counts a list, or a compressed string) as a compressed one, checked.

    pycocotools writes past its buffers where the counts do not add up to the size, so nothing from outside
    may reach it unchecked. Raises GeometryError.
    """
    height, width, counts = checked_counts(rle)
    return _as_text(coco.frPyObjects({"size": [height, width], "counts": counts}, height, width))


def outline_of_rle(rle: Any) -> Outline:
    """The outline of an RLE as a file holds it; GeometryError where it is not one or covers no pixel."""
    height, width, counts = checked_counts(rle)
    cut, corner = cut_of_counts(height, counts)
    return _outline(cut, corner=corner, image=(width, height))


def outline_of_mask(mask: Mask) -> Outline:
    """An outline that rasterises back to exactly this mask; one part a component (8-connected).

    Vertices are few, on a grid of 0.04 px, fitted by least squares to the points half way between inner and
    outer pixels, so that the area is that of the mask and no rim is drawn in or out. Where such a smooth
    polygon would change a pixel it gets more vertices there, and as a last resort the component follows
    its pixels' edges. Holes are joined to their part by bridges.
    """
    mask = np.ascontiguousarray(mask, np.uint8)
    x, y, width, height = cv2.boundingRect(mask)
    return _outline(mask[y : y + height, x : x + width], corner=(x, y), image=(mask.shape[1], mask.shape[0]))


def check_outline(outline: Any, *, width: int, height: int) -> Outline:
    """The outline of a cap in an image of this size, as floats, fit to be stored.

    Repeated vertices go. A part that crosses itself is replaced by what it covers of the image, as the
    rasteriser sees it (even-odd), in one part or several. Raises GeometryError for what is not a list of
    flat lists of finite numbers, for parts of fewer than three points, without area, of more than MAX_POINTS,
    further out than REACH images or outside the image altogether.
    """
    if not isinstance(outline, list) or not outline:
        raise GeometryError("The outline has no parts.")
    return [checked for part in outline for checked in _check_part(part, width, height)]


def check_mark(mark: Mark, *, width: int, height: int) -> Mark:
    """The mark, a polygon without repeated vertices; GeometryError where it makes no sense in the image."""
    if isinstance(mark, Polygon):
        points = _vertices(mark.points, width, height)
        if self_contact(points) == "crosses":
            raise GeometryError("The polygon crosses itself.")
        if abs(signed_area(points)) < LEAST_AREA:
            raise GeometryError("The polygon has no area.")
        return Polygon(part_of_points(points))
    figures = astuple(mark)
    if any(type(figure) not in (int, float) or not math.isfinite(figure) for figure in figures):
        raise GeometryError("A centre, a radius or an angle is not a finite number.")
    _check_reach(np.array([figures[:2]], dtype=np.float64), width, height)
    radii = (mark.r,) if isinstance(mark, Circle) else (mark.a, mark.b)
    if min(radii) <= 0 or max(radii) > REACH * max(width, height):
        raise GeometryError("A radius must be more than 0 and not many times the image.")
    return mark if isinstance(mark, Circle) else canonical_ellipse(*figures)


def _as_text(code: Rle) -> Rle:
    return {"size": [int(side) for side in code["size"]], "counts": code["counts"].decode("ascii")}


def _check_part(part: Any, width: int, height: int) -> Outline:
    if _plainly_good(part, width, height):
        return [list(map(float, part))]
    points = _vertices(part, width, height)
    if (points.min(axis=0) >= (width, height)).any() or (points.max(axis=0) <= 0).any():
        raise GeometryError("A polygon lies outside the image.")
    contact = self_contact(points)
    if contact == "crosses" or (contact == "touches" and not _fills_its_area(points)):
        return _covered(part_of_points(points), width, height)
    if abs(signed_area(points)) < LEAST_AREA:
        raise GeometryError("A polygon has no area.")
    return [part_of_points(points)]


def _plainly_good(part: Any, width: int, height: int) -> bool:
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
    if not set(map(type, part)) <= NUMBERS:
        raise GeometryError("A polygon's coordinates must be numbers.")
    if len(part) > 2 * MAX_POINTS:
        raise GeometryError(f"A polygon has {len(part) // 2} points; {MAX_POINTS} are allowed.")
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


def _fills_its_area(points: Points) -> bool:
    """Whether even-odd filling covers the shoelace area: true of a bridge to a hole, not of an eight."""
    low = np.floor(points.min(axis=0))
    width, height = (int(side) for side in np.ceil(points.max(axis=0) - low))
    code = rle_of_outline([part_of_points(points - low)], height=max(height, 1), width=max(width, 1))
    rim = np.hypot(*(points - np.roll(points, 1, axis=0)).T).sum()
    return abs(area_of_rle(code) - abs(signed_area(points))) <= 1 + rim / 2


def _covered(part: list[float], width: int, height: int) -> Outline:
    code = rle_of_outline([part], height=height, width=width)
    if area_of_rle(code) == 0:
        raise GeometryError("A polygon that crosses itself covers no pixel.")
    # By its counts, as a mask of the whole image would take a hundred times as long.
    return outline_of_rle(code)


def _outline(cut: Mask, *, corner: tuple[int, int], image: tuple[int, int]) -> Outline:
    """Of a piece of a mask; ``corner`` is x, y of its first pixel, ``image`` the whole's width and height."""
    return [
        _part_of_component(piece, offset=np.add(piece.corner, corner), image=np.array(image))
        for piece in components_of_mask(cut)
    ]


def _part_of_component(
    piece: Component, *, offset: NDArray[np.int64], image: NDArray[np.int64]
) -> list[float]:
    midpoints = [loop.midpoints for loop in piece.loops]
    knots = [knots_of_loop(points, tolerance=TOLERANCE) for points in midpoints]
    for _ in range(ROUNDS if piece.mask.sum() > SMALL else 0):
        fits = [
            fit_polygon(*pair).clip(-offset, image - offset) for pair in zip(midpoints, knots, strict=True)
        ]
        points = np.round(join_holes(fits[0], fits[1:]) * GRID) / GRID
        wrong = _mask_of_points(points, piece.mask) != piece.mask
        if not wrong.any():
            return part_of_points(without_repeats(np.round(points + offset, 2)))
        knots = [_more_knots(*pair, wrong) for pair in zip(piece.loops, knots, strict=True)]
    corners = [loop.corners for loop in piece.loops]
    return part_of_points(without_repeats(join_holes(corners[0], corners[1:]) + offset))


def _mask_of_points(points: Points, like: Mask) -> Mask:
    height, width = like.shape
    return mask_of_outline([part_of_points(points)], height=height, width=width)


def _more_knots(loop: Loop, knots: NDArray[np.int64], wrong: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The knots, and the cracks beside every pixel that came out wrong, with a neighbour on either side."""
    (inner_x, inner_y), (outer_x, outer_y) = loop.inside.T, loop.outside.T
    beside = wrong[inner_y, inner_x] | wrong[outer_y, outer_x]
    return np.union1d(knots, np.flatnonzero(beside | np.roll(beside, 1) | np.roll(beside, -1)))
