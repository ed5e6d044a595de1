"""Large photos in pieces that overlap: a cap is taken from the piece in whose own part it lies."""

from __future__ import annotations

from itertools import pairwise

from msgspec import Struct

LONGEST, SHORTEST = 1280, 768
"""Largest sides of a piece, pixels, along the photo's longer and shorter side. The network counts coordinates
from a piece's middle and was taught on photos of 1280 × 720: farther out it is lost."""
OVERLAP = 256
"""How far two pieces overlap unless less will do, pixels; caps up to this diameter are never cut."""
STEP = 64
"""Where a photo needs several pieces, their sides are whole multiples of this, as the network pads them."""


class Tile(Struct, frozen=True, kw_only=True):
    """One piece, and the part of it whose caps are taken from it, in the photo's pixels."""

    x: int
    y: int
    width: int
    height: int
    own: tuple[float, float, float, float]
    """Left, top, right, bottom of its own part. Those of all tiles fill the photo, edges in the later one."""

    def owns(self, x: float, y: float, *, slack: float = 0.0) -> bool:
        """Whether a cap with this middle belongs to this tile, or would within ``slack`` pixels."""
        left, top, right, bottom = self.own
        return left - slack <= x < right + slack and top - slack <= y < bottom + slack


def tiles_of(width: int, height: int, *, overlap: int = OVERLAP) -> list[Tile]:
    """The pieces of a photo, one where it is no larger than a piece; several overlap by ``overlap`` or more.

    They are as few as can be, and as small as so few can be.
    """
    across, down = (LONGEST, SHORTEST) if width >= height else (SHORTEST, LONGEST)
    return [
        Tile(x=x, y=y, width=w, height=h, own=(left, top, right, bottom))
        for y, h, top, bottom in _spans(height, down, overlap)
        for x, w, left, right in _spans(width, across, overlap)
    ]


def _spans(extent: int, longest: int, overlap: int) -> list[tuple[int, int, float, float]]:
    """First pixel, length, and the ends of the own part, of the pieces along one axis."""
    if extent <= longest:
        return [(0, extent, float("-inf"), float("inf"))]
    count = -(-(extent - overlap) // (longest - overlap))
    least = -(-(extent + (count - 1) * overlap) // count)
    length = min(-(-least // STEP) * STEP, longest)
    firsts = [round(nth * (extent - length) / (count - 1)) for nth in range(count)]
    seams = [(a + length + b) / 2 for a, b in pairwise(firsts)]
    edges = [float("-inf"), *seams, float("inf")]
    return [(first, length, edges[nth], edges[nth + 1]) for nth, first in enumerate(firsts)]
