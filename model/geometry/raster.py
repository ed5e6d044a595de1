"""Outlines, masks and run-length codes: every step between them goes through pycocotools' one rasteriser.

Outlines are those of ``model.geometry``. A mask is a uint8 array (height, width) of 0 and 1. An RLE is a
COCO dictionary ``{"size": [height, width], "counts": str}`` (compressed, ready for JSON).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pycocotools import mask as pycocotools_mask

from fairyring.model.geometry.rle import checked_counts
from fairyring.model.geometry.shapes import GeometryError, Outline

Mask = NDArray[np.uint8]
Rle = dict[str, Any]

coco: Any = pycocotools_mask
"""pycocotools' masks, untyped: their stubs know neither lists of polygons nor counts as text."""


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


def box_of_mask(mask: NDArray[np.bool_]) -> tuple[slice, slice]:
    """Rows and columns of the smallest box that holds all of a mask (height, width); it must not be empty."""
    columns, rows = np.flatnonzero(mask.any(0)), np.flatnonzero(mask.any(1))
    return slice(int(rows[0]), int(rows[-1]) + 1), slice(int(columns[0]), int(columns[-1]) + 1)


def rle_of_mask(mask: Mask) -> Rle:
    """Any array (height, width), non-zero where covered, as a compressed RLE."""
    return _as_text(coco.encode(np.asfortranarray(mask != 0, dtype=np.uint8)))


def mask_of_rle(rle: Rle) -> Mask:
    """An RLE of ours, or one that ``check_rle`` has passed, as a mask (height, width)."""
    return np.ascontiguousarray(coco.decode(rle))


def area_of_rle(rle: Rle) -> int:
    """Number of pixels that an RLE covers."""
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


def _as_text(code: Rle) -> Rle:
    return {"size": [int(side) for side in code["size"]], "counts": code["counts"].decode("ascii")}
