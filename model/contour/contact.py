"""Which points of a rim have another cap, or nothing but the image's border, right outside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.contour.rims import Rims
from model.contour.silhouette import Silhouette

REACH = (1.5, 3.0, 4.5)
"""How far outside a rim to look for a neighbour, pixels: outlines of masks leave gaps."""


@dataclass(frozen=True, slots=True)
class Contact:
    """What lies outside each of n × K points."""

    neighbour: NDArray[np.int_]
    """(n, K), index of the nearest other cap, −1 where there is none."""
    border: NDArray[np.bool_]
    """(n, K), whether the image ends here."""

    @property
    def free(self) -> NDArray[np.bool_]:
        """(n, K), where there is neither."""
        return (self.neighbour < 0) & ~self.border


def contact_of(caps: Sequence[Silhouette], rims: Rims, *, width: int, height: int) -> Contact:
    """Looks outward from each point of the rims of these caps, in an image of this size."""
    labels, left, top = _labels(caps)
    neighbour = np.full(rims.spacing.shape, -1)
    own = np.arange(len(caps))[:, None]
    for reach in reversed(REACH):
        x, y = np.moveaxis(np.floor(rims.points + reach * rims.outward).astype(np.int64), -1, 0)
        inside = (x >= left) & (x < left + labels.shape[1]) & (y >= top) & (y < top + labels.shape[0])
        there = labels[np.where(inside, y - top, 0), np.where(inside, x - left, 0)] - 1
        neighbour = np.where(inside & (there >= 0) & (there != own), there, neighbour)
    x, y = np.moveaxis(rims.points + REACH[0] * rims.outward, -1, 0)
    border = (x < 0) | (y < 0) | (x >= width) | (y >= height)
    return Contact(np.where(border, -1, neighbour), border)


def _labels(caps: Sequence[Silhouette]) -> tuple[NDArray[np.int32], int, int]:
    """A map of who is seen where (index + 1, 0 nobody), and the column and row it starts at."""
    left, top = min(cap.left for cap in caps), min(cap.top for cap in caps)
    right = max(cap.left + cap.mask.shape[1] for cap in caps)
    bottom = max(cap.top + cap.mask.shape[0] for cap in caps)
    labels = np.zeros((bottom - top, right - left), np.int32)
    for index, cap in enumerate(caps):
        rows, columns = cap.mask.shape
        y, x = cap.top - top, cap.left - left
        np.copyto(labels[y : y + rows, x : x + columns], index + 1, where=cap.mask.view(np.bool_))
    return labels, left, top
