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
    outside = rims.points + np.multiply.outer(REACH, rims.outward)
    x, y = outside[0, ..., 0], outside[0, ..., 1]
    border = (x < 0) | (y < 0) | (x >= width) | (y >= height)
    at = np.floor(outside).astype(np.int64) - (left, top)
    x, y = at[..., 0], at[..., 1]
    inside = (x >= 0) & (x < labels.shape[1]) & (y >= 0) & (y < labels.shape[0])
    there = np.where(inside, labels[np.where(inside, y, 0), np.where(inside, x, 0)] - 1, -1)
    there[there == np.arange(len(caps))[:, None]] = -1
    near, far, farthest = there
    neighbour = np.where(near >= 0, near, np.where(far >= 0, far, farthest))
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
