"""Light that surfaces throw on each other: what makes a bed of white caps glow.

A place shut off from the sky sees its neighbours instead, and a rim, which faces sideways, sees what lies
around it.
"""

from __future__ import annotations

import numpy as np

from fairyring.model.scene.pixels import Image, clipped, widely_blurred
from fairyring.model.scene.shine import Fallen

REACH = 16.0
"""How far light is thrown, px."""
CREAM = (0.90, 0.99, 1.0)
"""What is left of light, beside the reflectance, when it has been thrown once; blue first."""


def throw(fallen: Fallen, colour: Image, *, amount: float) -> None:
    """Adds to the light on surfaces of reflectance ``colour`` (3, rows, columns) what they throw.

    What faces sideways sees its surroundings instead of the sky. In a gap that is open by a share v, light
    comes and goes between walls of reflectance r: all its bounces together make v / (1 - r (1 - v)) of it.
    ``amount`` is the share of the light thrown that arrives.
    """
    rows, columns = fallen.opened.shape
    shut = 1 - fallen.opened
    for channel, kept in enumerate(CREAM):
        own = colour[channel]
        around = widely_blurred(fallen.light[channel] * own, REACH, (columns, rows))
        walls = clipped(amount * shut * widely_blurred(own, REACH, (columns, rows)), 0, 0.95)
        caught = fallen.upward * fallen.opened * walls / (1 - walls)
        fallen.light[channel] += np.float32(kept) * around * (amount * (1 - fallen.upward) + caught)
