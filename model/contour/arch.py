"""Equations 4 to 8: how far an arc bulges from the chord between its ends."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import Points

COINCIDENT = 1e-9
"""Ends nearer to each other than this, in pixels, are one point."""


def arch_curvature(radius: float) -> float:
    """Equation 4: C = 1 / R, in 1/px."""
    return 1 / radius


def arch_radius(*, chord: float, height: float, whole_chord: bool = False) -> float:
    """Equation 5, the sagitta formula: R = ½ ((z/2)² / h + h), pixels.

    The paper prints z² where the formula needs the half chord; ``whole_chord`` computes what is printed.
    """
    base = chord if whole_chord else chord / 2
    return 0.5 * (base**2 / height + height)


def chord_length(arc: Points) -> float:
    """Equation 6: z, the distance between the two ends of an arc, pixels."""
    return float(np.hypot(*(arc[-1] - arc[0])))


def arch_height(arc: Points) -> float:
    """Equation 7: h = max 2 S / z, the largest height of an inscribed triangle over the chord, pixels.

    Where the ends coincide the triangles are flat; the height is then the farthest point's distance.
    """
    chord = chord_length(arc)
    if chord < COINCIDENT:
        return float(np.hypot(*(arc - arc[0]).T).max())
    return float(2 * inscribed_triangle_areas(arc).max() / chord)


def inscribed_triangle_areas(arc: Points) -> NDArray[np.float64]:
    """Equation 8, Heron's formula: areas (n,) of the triangles that n points make with the arc's ends."""
    z = chord_length(arc)
    v = np.hypot(*(arc - arc[0]).T)
    m = np.hypot(*(arc - arc[-1]).T)
    p = (z + v + m) / 2
    # Rounding can push the product of a flat triangle a hair below zero.
    return np.sqrt(np.maximum(p * (p - z) * (p - v) * (p - m), 0))


def arch_ratio(arc: Points) -> float:
    """C* = h / z, the reading of "arch curvature" that the paper's thresholds fit.

    An arc of angle α has tan(α / 4) / 2: 0.6 is 201°, 0.9 is 244°. Infinite where the ends coincide.
    """
    chord = chord_length(arc)
    return arch_height(arc) / chord if chord >= COINCIDENT else float("inf")
