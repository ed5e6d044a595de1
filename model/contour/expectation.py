"""What is expected of a whole outline besides running through the visible rim.

How far a cap reaches, how round it is, and how little of it lies beyond the convex hull of what is visible:
terms of the log posterior that `harmonic.py` maximises. n caps, K rim points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.ellipse_parameters import LikelyEllipse

Array = NDArray[np.floating]

FILLS, REACHES = (0.5, 0.8), (0.02, -0.01)
"""Shares of the circle around what is visible that are filled, and the expected logarithms of the longest
radius over the circle's: little in sight narrows the circle, noise widens it."""
SMOOTH = 0.03
"""Below so much stretch the longest radius hardly differs from the mean one."""
TAIL = 2.0
"""From so many standard deviations on, stretches are expected as by Student's t: some caps are tilted."""
MORE_IN_SIGHT = 0.5
"""From this share of the rim in sight on, the hull of what is visible tells how far a cap goes …"""
MARGIN = 0.05
"""… within so much of it."""
BEYOND = 0.16
"""How far beyond a hidden corner of that hull a cap is expected to go, in radii …"""
FAR_BEYOND = 0.3
"""… and from where on the corner counts less."""


SHARED_ERROR = 1.5
"""Factor on the standard deviations of a likely ellipse: who said it drew the rim, too, and errs in both."""


@dataclass(frozen=True, slots=True)
class Expected:
    """Where n caps are expected to lie before their rims are looked at."""

    mean: Array
    """(n, 5): centre x, y, log r, u, v."""
    precision: Array
    """(n, 5, 5), of x/r, y/r, log r, u and v; 0 of caps of which nothing is expected."""


def expected_of(likely: Sequence[LikelyEllipse | None]) -> Expected:
    """What n ≥ 1 likely ellipses, as far as there are any, have one expect."""
    mean, precision = np.zeros((len(likely), 5)), np.zeros((len(likely), 5, 5))
    for nth, one in enumerate(likely):
        if one is not None:
            mean[nth] = one.parameters
            precision[nth] = np.linalg.inv(np.array(one.covariance) * SHARED_ERROR**2)
    return Expected(mean, precision)


def expected_reach(fill: Array) -> Array:
    """(n,), what log(longest radius / radius of the circle around what is visible) is expected to be.

    ``fill`` (n,) is the share of that circle that is filled.
    """
    return np.interp(fill, FILLS, REACHES)


@dataclass(frozen=True, slots=True)
class Reach:
    """The logarithms of the longest radii of n caps."""

    log_radius: Array
    """(n,)"""
    slope: Array
    """(n, 3), by log r, u and v."""


def reach_of(log_radius: Array, shape: Array) -> Reach:
    """Of n ellipses r·expm([[u, v], [v, −u]]); ``shape`` (n, 2 or more) starts with u, v."""
    stretch = np.sqrt(shape[:, 0] ** 2 + shape[:, 1] ** 2 + SMOOTH**2)
    slope = np.ones((len(shape), 3))
    slope[:, 1:] = shape[:, :2] / stretch[:, None]
    return Reach(log_radius + stretch - SMOOTH, slope)


def roundness(shape: Array, *, stretch: float) -> Array:
    """(n,), one over the variance that u and v are expected to have, less for the very stretched."""
    square = (shape[:, 0] ** 2 + shape[:, 1] ** 2) / stretch**2
    return stretch**-2 / (1 + square / TAIL**2)


def corners_that_count(corner: NDArray[np.bool_], coverage: Array) -> Array:
    """(n, K), how far corners of the hulls count, 0 to 1, where such shares (n,) of the rims are in sight."""
    in_sight = 1 / (1 + np.exp(np.clip((MORE_IN_SIGHT - coverage) / MARGIN, -50, 50)))
    return corner * in_sight[:, None]


def corner_information(residual: Array, radius: Array) -> Array:
    """(n, K), information of hidden corners that lie inside the outline, 1/px²; both given in pixels.

    ``residual`` (n, K) is how far a point lies outside, ``radius`` (n,) the outlines'.
    """
    depth = residual / radius[:, None]
    near = 1 / (1 + (depth / FAR_BEYOND) ** 2) ** 2
    return np.where(residual < 0, near, 0) / (BEYOND * radius[:, None]) ** 2
