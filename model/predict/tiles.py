"""Large photos in pieces that overlap: a cap is taken from the piece in whose own part it lies."""

from __future__ import annotations

from itertools import pairwise

from msgspec import Struct

SIDE = 1280
"""Largest width and height of a piece, photo pixels: as wide as the photos the network is made for."""
OVERLAP = 256
"""How far two pieces overlap, photo pixels; caps up to this diameter are never cut."""


class Tile(Struct, frozen=True, kw_only=True):
    """One piece, and the part of it whose caps are taken from it, in photo coordinates."""

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


def tiles_of(width: int, height: int) -> list[Tile]:
    """The pieces of a photo, one where it is no larger than a piece."""
    return [
        Tile(x=x, y=y, width=w, height=h, own=(left, top, right, bottom))
        for y, h, top, bottom in _spans(height)
        for x, w, left, right in _spans(width)
    ]


def _spans(extent: int) -> list[tuple[int, int, float, float]]:
    """First pixel, length, and the ends of the own part, of the pieces along one axis."""
    if extent <= SIDE:
        return [(0, extent, float("-inf"), float("inf"))]
    count = -(-(extent - OVERLAP) // (SIDE - OVERLAP))
    firsts = [round(nth * (extent - SIDE) / (count - 1)) for nth in range(count)]
    seams = [(a + SIDE + b) / 2 for a, b in pairwise(firsts)]
    edges = [float("-inf"), *seams, float("inf")]
    return [(first, SIDE, edges[nth], edges[nth + 1]) for nth, first in enumerate(firsts)]
