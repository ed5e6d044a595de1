"""Coordinates that are fractions of the photo's sides, which some programs write, in place of pixels."""

from __future__ import annotations

from collections.abc import Iterable

from fairyring.storage.errors import StoreError
from fairyring.storage.formats.found import FoundCap

LARGEST_FRACTION = 1.5
"""Outlines of a file that reach no further, in pixels or fractions, cannot be caps in pixels."""


def require_pixels(caps: Iterable[FoundCap]) -> None:
    """Raises StoreError where all outlines that a file holds seem to be in fractions."""
    outlines = (cap.cap.visible for cap in caps if cap.cap.visible)
    first = next(outlines, None)
    if first is None or _reaches_further(first) or any(_reaches_further(outline) for outline in outlines):
        return
    raise StoreError(
        "All its coordinates lie between 0 and 1: they seem to be fractions of the photo's width and height. "
        "Multiply x by the width and y by the height, or export pixels."
    )


def _reaches_further(outline: list[list[float]]) -> bool:
    """Whether it has a coordinate beyond, or none that could be compared."""
    numbers = [number for part in outline if isinstance(part, list) for number in part]
    plain = [number for number in numbers if type(number) in (int, float)]
    return not plain or len(plain) < len(numbers) or not all(0 <= x <= LARGEST_FRACTION for x in plain)
