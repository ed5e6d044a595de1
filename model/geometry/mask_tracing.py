"""Masks as outlines that rasterise back to exactly the same pixels, and the rims of masks.

A mask is a uint8 array (height, width), non-zero where covered.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.bridges import join_holes
from fairyring.model.geometry.cracks import Loop, Loops, Piece, loops_of_mask
from fairyring.model.geometry.polygon_fit import fit_polygon, knots_of_loop
from fairyring.model.geometry.raster import Mask, mask_of_outline
from fairyring.model.geometry.rle import checked_counts, cut_of_counts
from fairyring.model.geometry.shapes import GeometryError, Outline, Points, part_of_points, without_repeats

TOLERANCE = 0.5
"""How far a first smooth outline may lie from the midpoints of the mask's edges, pixels."""
ROUNDS = 4
"""Attempts at a smooth outline before the pixels' edges are taken."""
GRID = 25
"""Vertices a pixel of a smooth outline: no multiple of 1/25 lies where the rasteriser, which works in fifths,
rounds one way or the other by the last bit."""
SMALL = 8
"""A piece of at most so many pixels follows its pixels' edges: it is too small to fit."""

MANY = 20
"""A mask of more pieces and holes than this is noisy, and its specks are left out."""
SPECK = 4
"""A piece or a hole of a noisy mask with fewer pixels than this is a speck."""
SPECK_SHARE = 0.001
"""A piece or a hole of a noisy mask with less than this share of the largest piece is a speck, too."""
MOST_LOOPS = 500
"""Most pieces and holes that may be left; a mask of more is refused."""
MOST_BOXED = 1 << 26
"""Most pixels in the boxes around all pieces together."""


def outline_of_mask(mask: Mask) -> Outline:
    """An outline that rasterises back to exactly this mask; one part a piece (8-connected).

    Vertices are few, on a grid of 0.04 px, fitted by least squares to the points half way between inner and
    outer pixels, so that the area is that of the mask and no rim is drawn in or out. Where such a smooth
    polygon would change a pixel it gets more vertices there, and as a last resort the piece follows
    its pixels' edges. Holes are joined to their part by bridges.

    Raises GeometryError for a mask of more than MOST_LOOPS pieces and holes, or with too long a rim.
    """
    mask = np.ascontiguousarray(mask, np.uint8)
    x, y, width, height = cv2.boundingRect(mask)
    loops = loops_of_mask(mask[y : y + height, x : x + width])
    rows, columns = mask.shape
    return _outline(loops, kept=np.ones(len(loops), bool), corner=(x, y), image=(columns, rows))


def outline_of_rle(rle: Any, *, left_out: Callable[[str], object] = lambda _what: None) -> Outline:
    """The outline of an RLE as a file holds it.

    As ``outline_of_mask``, but where there are more than MANY pieces and holes, those of fewer than SPECK
    pixels, or SPECK_SHARE of the largest piece, are noise: ``left_out`` hears how many. Raises GeometryError
    where it is not an RLE, covers no pixel or cannot be traced.
    """
    height, width, counts = checked_counts(rle)
    cut, corner = cut_of_counts(height, counts)
    loops = loops_of_mask(cut)
    kept = np.ones(len(loops), bool)
    if len(loops) > MANY:
        areas = np.abs(loops.areas)
        least = max(SPECK, SPECK_SHARE * areas.max())
        kept = areas >= min(least, areas.max())
    if specks := np.count_nonzero(~kept):
        left_out(f"{specks} specks and holes of a few pixels were left out of its noisy mask.")
    return _outline(loops, kept=kept, corner=corner, image=(width, height))


def rim_of_mask(mask: Mask) -> Points:
    """(n, 2): the points half way between inner and outer pixels, without those of holes."""
    loops = loops_of_mask(mask)
    rims = [piece.outer.midpoints for piece in loops.pieces(loops.areas > 0)]
    return np.concatenate(rims) if rims else np.zeros((0, 2))


def _outline(
    loops: Loops, *, kept: NDArray[np.bool_], corner: tuple[int, int], image: tuple[int, int]
) -> Outline:
    """Of a part of a mask; ``corner``: x, y of its first pixel; ``image``: width and height of the whole."""
    if (count := np.count_nonzero(kept)) > MOST_LOOPS:
        raise GeometryError(
            f"The mask has {count} pieces and holes, more than {MOST_LOOPS}; fill and remove the small ones."
        )
    pieces = loops.pieces(kept)
    if sum(np.ptp(piece.outer.starts, axis=0).prod() for piece in pieces) > MOST_BOXED:
        raise GeometryError("The mask's pieces lie one around the other; give each a mask of its own.")
    return [_part_of_piece(piece, corner=np.array(corner), image=np.array(image)) for piece in pieces]


def _part_of_piece(piece: Piece, *, corner: NDArray[np.int64], image: NDArray[np.int64]) -> list[float]:
    """In a box of its own, one pixel wider on every side, whose first pixel is ``offset`` in the image."""
    low, high = piece.outer.starts.min(axis=0) - 1, piece.outer.starts.max(axis=0) + 1
    offset = low + corner
    loops = [loop.moved(-low) for loop in (piece.outer, *piece.holes)]
    by_pixels = _joined([loop.corners for loop in loops])
    wanted = _mask_of_points(by_pixels, high - low)
    midpoints = [loop.midpoints for loop in loops]
    knots = [knots_of_loop(points, tolerance=TOLERANCE) for points in midpoints]
    for _ in range(ROUNDS if np.count_nonzero(wanted) > SMALL else 0):
        fits = [
            fit_polygon(*pair).clip(-offset, image - offset) for pair in zip(midpoints, knots, strict=True)
        ]
        points = np.round(_joined(fits) * GRID) / GRID
        wrong = _mask_of_points(points, high - low) != wanted
        if not wrong.any():
            return part_of_points(without_repeats(np.round(points + offset, 2)))
        knots = [_more_knots(*pair, wrong) for pair in zip(loops, knots, strict=True)]
    return part_of_points(without_repeats(by_pixels + offset))


def _joined(polygons: list[Points]) -> Points:
    """The outer polygon, the first, with its holes."""
    return join_holes(polygons[0], polygons[1:])


def _mask_of_points(points: Points, size: NDArray[np.int64]) -> Mask:
    width, height = size.tolist()
    return mask_of_outline([part_of_points(points)], height=height, width=width)


def _more_knots(loop: Loop, knots: NDArray[np.int64], wrong: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The knots, and the cracks beside every pixel that came out wrong, with a neighbour on either side."""
    (inner_x, inner_y), (outer_x, outer_y) = loop.inside.T, loop.outside.T
    beside = wrong[inner_y, inner_x] | wrong[outer_y, outer_x]
    return np.union1d(knots, np.flatnonzero(beside | np.roll(beside, 1) | np.roll(beside, -1)))
