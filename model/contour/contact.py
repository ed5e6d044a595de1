"""Which points of a rim have another cap, or nothing but the image's border, right outside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fairyring.model.contour.rims import Rims
from fairyring.model.contour.silhouette import Silhouette

REACH = (1.5, 3.0, 4.5)
"""How far outside a rim to look for a neighbour, the nearest first, pixels: outlines of masks leave gaps."""

NOBODY, ELSEWHERE = -1, -2
"""Codes for no neighbour, and for one that is not among the caps given."""


@dataclass(frozen=True, slots=True)
class Contact:
    """What lies outside each of n × K points."""

    neighbour: NDArray[np.int_]
    """(n, K), index of the nearest other cap among those at hand; else `NOBODY` or `ELSEWHERE`."""
    border: NDArray[np.bool_]
    """(n, K), whether the image ends here."""

    @property
    def free(self) -> NDArray[np.bool_]:
        """(n, K), where there is neither."""
        return (self.neighbour == NOBODY) & ~self.border


def contact_of(rims: Rims, caps: Sequence[Silhouette], *, width: int, height: int) -> Contact:
    """Looks outward from each point of n rims in an image of this size.

    ``caps`` are those in sight from there, n or more; the first n are the ones whose rims these are.
    """
    outside = rims.points + np.multiply.outer(REACH, rims.outward)
    x, y = outside[0, ..., 0], outside[0, ..., 1]
    border = (x < 0) | (y < 0) | (x >= width) | (y >= height)
    at = np.floor(outside).astype(np.int64)
    labels, left, top = _labels(caps, at)
    x, y = at[..., 0] - left, at[..., 1] - top
    there = labels[y, x] - 1  # 0 is nobody
    there[there == np.arange(len(rims.points))[:, None]] = NOBODY
    near, far, farthest = there
    neighbour = np.where(near >= 0, near, np.where(far >= 0, far, farthest))
    return Contact(np.where(border, NOBODY, neighbour), border)


def _labels(caps: Sequence[Silhouette], at: NDArray[np.int64]) -> tuple[NDArray[np.int32], int, int]:
    """A map of who is seen where (index + 1, 0 nobody) around the pixels ``at`` (…, 2), with its corner.

    Where two overlap the smaller one is seen, whatever their order.
    """
    (left, top), (right, bottom) = at.min(axis=(0, 1, 2)), at.max(axis=(0, 1, 2)) + 1
    labels = np.zeros((bottom - top, right - left), np.int32)
    smaller_later = sorted(range(len(caps)), key=lambda index: (-caps[index].pixels, caps[index].content))
    for index in smaller_later:
        x0, y0, x1, y1 = caps[index].box
        x, y = max(x0, left), max(y0, top)
        columns, rows = min(x1, right) - x, min(y1, bottom) - y
        if columns > 0 and rows > 0:
            seen = caps[index].mask[y - y0 : y - y0 + rows, x - x0 : x - x0 + columns].view(np.bool_)
            np.copyto(labels[y - top : y - top + rows, x - left : x - left + columns], index + 1, where=seen)
    return labels, int(left), int(top)
