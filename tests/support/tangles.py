"""Closed polygons that nobody would draw: thousands of points, spirals, stars, combs, tangles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
MIDDLE = np.array([1000.0, 1000.0])


def star(count: int, *, inner: float, outer: float = 500.0) -> Points:
    """(count, 2): vertices on two circles in turn."""
    angles = np.arange(count) * 2 * np.pi / count
    radii = np.where(np.arange(count) % 2, inner, outer)
    return MIDDLE + radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def spiral(count: int, *, turns: float, thick: float) -> Points:
    """(count, 2): there and back again beside itself."""
    share = np.linspace(0, 1, count // 2)
    angles, radii = share * turns * 2 * np.pi, 20 + 500 * share
    rims = [np.stack([r * np.cos(angles), r * np.sin(angles)], axis=1) for r in (radii, radii - thick)]
    return MIDDLE + np.concatenate([rims[0], rims[1][::-1]])


def comb(count: int, *, long: float, degrees: float = 0) -> Points:
    """(count, 2): needles beside each other, turned."""
    x, y = np.arange(count) * 0.2, np.where(np.arange(count) % 2, long, 0.0)
    y[[0, -1]] = -10
    turn = np.exp(1j * np.radians(degrees)) * (x + 1j * y)
    return MIDDLE + np.stack([turn.real, turn.imag], axis=1)


def scattered(count: int, *, seed: int = 0) -> Points:
    """(count, 2): anywhere in 2000 × 2000 pixels."""
    return np.random.default_rng(seed).uniform(0, 2000, (count, 2))


def zigzag(count: int) -> Points:
    """(count, 2): to and fro between two uprights, and back at once across all of it."""
    x = np.where(np.arange(count) % 2, 100.0, 1900.0)
    return np.stack([x, np.linspace(100, 1900, count)], axis=1)


def collinear(count: int) -> Points:
    """(count, 2): along two sides of a triangle and back along the third in many small steps."""
    corners = np.array([[100, 100], [1900, 200], [300, 1900], [100, 100]])
    return np.stack([np.interp(np.linspace(0, 3, count), range(4), side) for side in corners.T], axis=1)


def to_and_fro(count: int) -> Points:
    """(count, 2): the same few points again and again, and needles without width."""
    return scattered(count)[np.random.default_rng(2).integers(0, min(count, 7), count)]


def trembling(count: int) -> Points:
    """(count, 2): a circle drawn with points far nearer to each other than they are true."""
    return star(count, inner=500) + np.random.default_rng(1).normal(0, 0.5, (count, 2))
