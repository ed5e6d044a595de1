"""What falls on surfaces from the lamp and from the sky."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from fairyring.model.scene.layers import strips, window
from fairyring.model.scene.light import Light
from fairyring.model.scene.pixels import Image, clipped, tinted
from fairyring.model.scene.shade import Shade, open_sky, passed

ROUGHNESS = 0.10
"""How far round to where the light does not fall a rough skin is lit."""


class Fallen(NamedTuple):
    """Light on surfaces, and what else can reach them."""

    light: Image
    """(3, rows, columns), linear, blue first."""
    upward: Image
    """Share of what they face that is sky: 1 level, 0.5 upright. (rows, columns)"""
    opened: Image
    """Share of that sky which nothing stands in front of. (rows, columns)"""


def shine(normal: Image, z: Image, *, light: Light, shade: Shade) -> Fallen:
    """``normal`` (3, rows, columns), of any length, and ``z`` (rows, columns) are of whatever is seen."""
    fallen = Fallen(np.empty_like(normal), np.empty_like(z), np.empty_like(z))
    for box in strips(*z.shape):
        here = window(box)
        level, facing = _faced(normal[:, *here], light)
        key = _lit(facing) + light.gloss * _mirrored(facing, level, light)
        nearer = 1 + clipped(z[here] * np.float32(2 / light.height), -100 / light.height, 600 / light.height)
        key *= passed(shade, z[here], here, softness=light.softness) * nearer
        fallen.upward[here] = 0.5 + 0.5 * level
        fallen.opened[here] = open_sky(shade, z[here], here)
        sky = fallen.opened[here] * fallen.upward[here]
        fallen.light[:, *here] = tinted(key, light.key) + tinted(sky, light.sky)
    return fallen


def _faced(normal: Image, light: Light) -> tuple[Image, Image]:
    """How much of a surface faces up, and how much the light."""
    x, y, up = light.direction
    across, along, level = normal
    size = 1 / np.sqrt(across * across + along * along + level * level)
    level = level * size
    return level, (across * x + along * y) * size + level * up


def _lit(facing: Image) -> Image:
    return clipped((facing + ROUGHNESS) * np.float32(1 / (1 + ROUGHNESS)), 0, 1)


def _mirrored(facing: Image, level: Image, light: Light) -> Image:
    """A moist skin mirrors the light half way between it and the camera, softly."""
    mirrored = clipped((facing + level) * np.float32(1 / math.sqrt(2 + 2 * light.direction[2])), 0, 1)
    for _ in range(4):
        mirrored *= mirrored
    return mirrored
