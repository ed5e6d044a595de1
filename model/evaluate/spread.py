"""How centres scatter: the ellipse that holds most of them if they scatter normally."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

OF_95 = 2.4477
"""Standard deviations from the mean that 95 of 100 of a normal distribution in two dimensions stay within."""

MANY = 50
"""From so many points on some may lie beyond the edges of a plot, so that one of them does not shrink all."""


def reach_of(moves: NDArray[np.float64]) -> float:
    """How far a plot of these errors (n, 2), two at least, reaches from its middle, in their unit.

    It holds all of a few points, most of many, and always the whole ellipse that ``axes_of_spread`` tells.
    """
    sizes = np.abs(moves)
    furthest = np.quantile(sizes, 0.98) if len(moves) >= MANY else sizes.max()
    ends = np.abs(moves.mean(axis=0)) + OF_95 * moves.std(axis=0, ddof=1)
    return 1.1 * max(float(furthest), float(ends.max()), 0.1)


def axes_of_spread(moves: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The semi-axes (2,) of the ellipse that holds 95 of 100, the shorter first, and their directions (2, 2).

    Args:
        moves: (n, 2) signed errors along x and y, at least two of them.
    """
    values, vectors = np.linalg.eigh(np.cov(moves.T))
    return OF_95 * np.sqrt(np.maximum(values, 0)), vectors


def ellipse_of_spread(
    moves: NDArray[np.float64], *, count: int = 60
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The same ellipse as its upper and its lower half, both (count, 2) from left to right at the same x."""
    radii, vectors = axes_of_spread(moves)
    matrix = (vectors * radii**2) @ vectors.T
    wide = float(np.sqrt(matrix[0, 0]))
    turn = np.linspace(-np.pi / 2, np.pi / 2, count)
    across = wide * np.sin(turn)
    if wide == 0:
        tall = np.zeros(count)
        middle = np.zeros(count)
    else:
        middle = across * matrix[0, 1] / matrix[0, 0]
        tall = np.cos(turn) * np.sqrt(max(matrix[1, 1] - matrix[0, 1] ** 2 / matrix[0, 0], 0.0))
    x, y = moves.mean(axis=0)
    return (
        np.stack([x + across, y + middle + tall], axis=1),
        np.stack([x + across, y + middle - tall], axis=1),
    )
