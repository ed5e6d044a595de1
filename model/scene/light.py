"""The paper's three light sources (Figure 4)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fairyring.model.light_and_form import LightSource


class Light(NamedTuple):
    """One image's light; colours are linear, blue first."""

    direction: NDArray[np.float32]
    """(3,) towards the light, view coordinates, unit."""
    elevation: float
    """Over the picture's plane, radians."""
    key: NDArray[np.float32]
    sky: NDArray[np.float32]
    softness: float
    """Half the light's angular size, radians."""
    slant: float
    """Share of the key lost across the picture, away from the light."""
    height: float
    """How high over the soil it hangs, px: what stands nearer to it is brighter."""
    gloss: float
    """How much of it a moist skin mirrors."""
    dimness: float
    """How much more noise the sensor makes of it: 1 in good light."""


def draw_light(source: LightSource, rng: np.random.Generator) -> Light:
    """A light of one of the three kinds."""
    azimuth, lift, warmth, slant, power, nearness, gloss = rng.random(7).tolist()
    elevation = np.radians({"top": 60 + 22 * lift, "side": 17 + 17 * lift, "dark": 40 + 40 * lift}[source])
    level = {"top": 0.92 + 0.24 * power, "side": 0.85 + 0.3 * power, "dark": 0.17 + 0.13 * power}[source]
    sky = {"top": 0.10 + 0.14 * gloss, "side": 0.10 + 0.06 * power, "dark": 0.10}[source]
    cast = 0.10 * (warmth - 0.5) if source == "top" else 0.30 * (warmth - 0.35)
    colour = np.array([1 - cast, 1, 1 + cast], np.float32)
    across = 2 * np.pi * azimuth
    level_part = np.cos(elevation)
    direction = np.array([level_part * np.cos(across), level_part * np.sin(across), np.sin(elevation)])
    return Light(
        direction=direction.astype(np.float32),
        elevation=float(elevation),
        key=(level * colour).astype(np.float32),
        sky=(sky * (0.6 + 0.4 * level) * (2 - colour)).astype(np.float32),
        softness={"top": 0.3 + 0.2 * nearness, "side": 0.07, "dark": 0.20}[source],
        slant={"top": 0.1 + 0.2 * slant, "side": 0.3 + 0.3 * slant, "dark": 0.4}[source],
        height=700 + 700 * nearness,
        gloss=0.15 * gloss,
        dimness={"top": 1.0, "side": 1.3, "dark": 3.5}[source],
    )
