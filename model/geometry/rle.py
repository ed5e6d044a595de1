"""COCO's run-length codes as files hold them, checked before pycocotools sees them.

The counts are of pixels column by column, uncovered and covered in turn, beginning with uncovered ones.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import GeometryError

MAX_PIXELS = 1 << 30
"""Most pixels of the image that an RLE says it is of: a size in a file costs nothing to write."""
MOST_BOXED = 1 << 25
"""Most pixels of the box around what is covered; nothing larger is decoded."""
MOST_COUNTS = 500_000
"""Most counts; a mask of more is noise."""
MOST_TEXT = 4 * MOST_COUNTS
"""Most characters of compressed counts; a usual count takes one or two."""
MAX_SHIFT = 60
"""Most bits of one count, far more than any image needs."""


def checked_counts(rle: Any) -> tuple[int, int, list[int]]:
    """Height, width and counts of an RLE as a file holds it, its counts a list or compressed.

    Raises GeometryError where it is no RLE.
    """
    if not isinstance(rle, dict) or "size" not in rle or "counts" not in rle:
        raise GeometryError("The RLE lacks its size or its counts.")
    size = _whole_numbers(rle["size"])
    if size is None or len(size) != 2 or min(size) < 1:
        raise GeometryError("The size of an RLE must be two positive whole numbers, height and width.")
    height, width = size
    if height * width > MAX_PIXELS:
        raise GeometryError(f"An RLE of {width} × {height} pixels is larger than any mask may be.")
    counts = rle["counts"]
    most = MOST_COUNTS if isinstance(counts, list) else MOST_TEXT
    if isinstance(counts, str | bytes | list) and len(counts) > most:
        raise GeometryError(f"The RLE has more than {MOST_COUNTS} counts; smooth the mask.")
    if isinstance(counts, str | bytes):
        counts = _counts_of_text(counts)
    counts = _whole_numbers(counts)
    if counts is None or any(count < 0 for count in counts):
        raise GeometryError("The counts of an RLE must be whole numbers, none below zero.")
    if sum(counts) != height * width:
        raise GeometryError(f"The counts of the RLE do not add up to its {width} × {height} pixels.")
    return height, width, counts


def _whole_numbers(values: Any) -> list[int] | None:
    """The values as integers, 150.0 as 150; None where one is no whole number, or it is no list."""
    if not isinstance(values, list | tuple):
        return None
    if all(type(value) is int for value in values):
        return [*values]
    if all(type(value) is int or (type(value) is float and value.is_integer()) for value in values):
        return [int(value) for value in values]
    return None


def cut_of_counts(height: int, counts: list[int]) -> tuple[NDArray[np.uint8], tuple[int, int]]:
    """The smallest box around all covered pixels, as a mask, and the x, y of its first pixel in the image.

    Nothing outside that box is decoded. GeometryError where no pixel is covered, or the box holds more than
    MOST_BOXED.
    """
    ends = np.cumsum(counts)
    starts, ends = ends[0::2][: len(counts) // 2], ends[1::2]
    lit = ends > starts
    if not lit.any():
        raise GeometryError("The RLE covers no pixel.")
    column, top, bottom = _within_columns(starts[lit], ends[lit], height)
    left, right = int(column[0]), int(column[-1]) + 1
    first, last = int(top.min()), int(bottom.max())
    if (right - left) * (last - first) > MOST_BOXED:
        raise GeometryError(
            f"The mask spans {right - left} × {last - first} pixels, more than any cap; scale the photo down."
        )
    # One up where a stretch begins and one down behind its end: their sums are the mask.
    changes = np.zeros((right - left, last - first + 1), np.int8)
    np.add.at(changes, (column - left, top - first), 1)
    np.add.at(changes, (column - left, bottom - first), -1)
    cut = np.cumsum(changes, axis=1, dtype=np.int8)[:, :-1]
    return np.ascontiguousarray(cut.T).view(np.uint8), (left, first)


def _within_columns(
    starts: NDArray[np.int64], ends: NDArray[np.int64], height: int
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Stretches, from ``starts`` to before ``ends``, cut where they go on in the next column.

    Column, first row and row behind the last of each, column by column.
    """
    first, last = starts // height, (ends - 1) // height
    pieces = last - first + 1
    if pieces.sum() > MOST_COUNTS:
        raise GeometryError(f"The RLE has more than {MOST_COUNTS} counts; smooth the mask.")
    nth = np.arange(pieces.sum()) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    column = np.repeat(first, pieces) + nth
    top = np.where(nth == 0, np.repeat(starts % height, pieces), 0)
    bottom = np.where(column == np.repeat(last, pieces), np.repeat((ends - 1) % height + 1, pieces), height)
    return column, top, bottom


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
