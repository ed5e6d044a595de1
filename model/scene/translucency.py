"""Light in flesh: what goes in under the skin comes out again a little way off."""

from __future__ import annotations

import numpy as np

from fairyring.model.scene.pixels import Image, blurred

LEAST = 1e-3
"""Share of flesh below which a place takes no part."""


def creep(light: Image, flesh: Image, *, reach: float) -> None:
    """Spreads the light on surfaces (3, rows, columns) within flesh, by a Gaussian of ``reach`` px.

    ``flesh`` (rows, columns) is how much of each pixel is cap, stalk or tissue. Neighbours that touch pass
    light on to each other; soil takes none and gives none.
    """
    if reach <= 0:
        return
    around = flesh / np.maximum(blurred(flesh, reach), LEAST)
    for channel in range(len(light)):
        crept = blurred(light[channel] * flesh, reach) * around
        light[channel] *= 1 - flesh
        light[channel] += crept
