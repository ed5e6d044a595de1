"""COCO's run-length codes as files hold them, checked before pycocotools sees them.

The counts are of pixels column by column, uncovered and covered in turn, beginning with uncovered ones.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import GeometryError

MAX_PIXELS = 1 << 30
"""No mask larger than this is decoded: a size in a file costs nothing to write."""
MAX_SHIFT = 60
"""Bits of one count, far more than any image needs."""


def checked_counts(rle: Any) -> tuple[int, int, list[int]]:
    """Height, width and counts of an RLE as a file holds it, its counts a list or compressed.

    Raises GeometryError where it is no RLE.
    """
    if not isinstance(rle, dict) or "size" not in rle or "counts" not in rle:
        raise GeometryError("The RLE lacks its size or its counts.")
    size = rle["size"]
    if not isinstance(size, list | tuple) or len(size) != 2 or any(type(n) is not int or n < 1 for n in size):
        raise GeometryError("The size of an RLE must be two positive whole numbers, height and width.")
    height, width = size
    if height * width > MAX_PIXELS:
        raise GeometryError(f"An RLE of {width} × {height} pixels is larger than any mask may be.")
    counts = rle["counts"]
    if isinstance(counts, str | bytes):
        counts = _counts_of_text(counts)
    if not isinstance(counts, list) or any(type(count) is not int or count < 0 for count in counts):
        raise GeometryError("The counts of an RLE must be whole numbers, none below zero.")
    if sum(counts) != height * width:
        raise GeometryError(f"The counts of the RLE do not add up to its {width} × {height} pixels.")
    return height, width, counts


def cut_of_counts(height: int, counts: list[int]) -> tuple[NDArray[np.uint8], tuple[int, int]]:
    """The smallest box around all covered pixels, as a mask, and the x, y of its first pixel in the image.

    Decoding just that takes a small part of the time that the whole image does. GeometryError where no pixel
    is covered.
    """
    ends = np.cumsum(counts)
    lit = np.flatnonzero(counts[1::2]) * 2 + 1
    if not len(lit):
        raise GeometryError("The RLE covers no pixel.")
    first, last = int(ends[lit[0] - 1]) // height, (int(ends[lit[-1]]) - 1) // height
    low, high = first * height, (last + 1) * height
    lengths = np.diff(ends.clip(low, high), prepend=low)
    covered = np.arange(len(counts)) % 2 == 1
    columns = np.repeat(covered, lengths).reshape(-1, height)
    rows = np.flatnonzero(columns.any(axis=0))
    cut = columns[:, rows[0] : rows[-1] + 1].T
    return np.ascontiguousarray(cut, np.uint8), (first, int(rows[0]))


def _counts_of_text(text: str | bytes) -> list[int]:
    """COCO's compressed counts: five bits a character, the sixth says more follow.

    From the fourth on they are differences to the count before last. Raises GeometryError.
    """
    codes = map(ord, text) if isinstance(text, str) else text
    counts: list[int] = []
    value = shift = 0
    for code in codes:
        digit = code - 48
        if not 0 <= digit < 64 or shift > MAX_SHIFT:
            raise GeometryError("The counts of the RLE are not in COCO's compressed form.")
        value |= (digit & 31) << shift
        shift += 5
        if digit & 32:
            continue
        if digit & 16:
            value -= 1 << shift
        counts.append(value + counts[-2] if len(counts) > 2 else value)
        value = shift = 0
    if shift:
        raise GeometryError("The counts of the RLE break off.")
    return counts
