"""Polygons of few vertices that run, by least squares, along closed chains of points."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import Points

SMOOTHING_ROUNDS = 6
"""The fit's error halves each round, from under half a pixel."""


def knots_of_loop(midpoints: Points, *, tolerance: float) -> NDArray[np.int64]:
    """Indices, ascending, of the midpoints (n, 2), at least 3, that a polygon within ``tolerance`` keeps."""
    kept = cv2.approxPolyDP(midpoints.astype(np.float32), tolerance, closed=True).reshape(-1, 2)
    if len(kept) < 3:
        return np.arange(len(midpoints))
    # Midpoints are multiples of a half and each occurs once, so they can be looked up as integers.
    height = 4 * int(midpoints[:, 1].max()) + 4
    keys = (midpoints * 2).astype(np.int64) @ (height, 1)
    order = np.argsort(keys)
    return np.sort(order[np.searchsorted(keys, (kept * 2).astype(np.int64) @ (height, 1), sorter=order)])


def fit_polygon(midpoints: Points, knots: NDArray[np.int64]) -> Points:
    """(k, 2) vertices of the closed polygon that runs closest, by least squares, to the midpoints (n, 2).

    ``knots`` (k ≥ 3, ascending) are the midpoints where one edge ends and the next begins. The normal
    equations of this piecewise linear fit are cyclic, tridiagonal and dominated by their diagonal, so
    a few Jacobi rounds solve them.
    """
    rotated = np.concatenate((midpoints[knots[0] :], midpoints[: knots[0]]))
    path = rotated[:, 0] + 1j * rotated[:, 1]
    starts = knots - knots[0]
    lengths = np.diff(starts, append=len(path))
    late = (np.arange(len(path)) - np.repeat(starts, lengths)) / np.repeat(lengths, lengths)
    early = 1 - late
    coupling = np.add.reduceat(early * late, starts)
    diagonal = np.add.reduceat(early**2, starts) + _before(np.add.reduceat(late**2, starts))
    target = np.add.reduceat(early * path, starts) + _before(np.add.reduceat(late * path, starts))
    vertices = path[starts]
    for _ in range(SMOOTHING_ROUNDS):
        vertices = (target - coupling * _after(vertices) - _before(coupling * vertices)) / diagonal
    return np.stack([vertices.real, vertices.imag], axis=1)


def _before(values: NDArray[Any]) -> NDArray[Any]:
    """Each one's predecessor round the loop (``np.roll`` takes longer than the sums here)."""
    return np.concatenate((values[-1:], values[:-1]))


def _after(values: NDArray[Any]) -> NDArray[Any]:
    return np.concatenate((values[1:], values[:1]))
