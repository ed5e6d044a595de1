"""What stands in the light's way: cast shadows, and how much of the sky a place is shut off from."""

from __future__ import annotations

import math
from typing import NamedTuple

import cv2
import numpy as np

from fairyring.model.scene.light import Light
from fairyring.model.scene.pixels import Image, clipped, widely_blurred

HALF = 0.5
"""Shade is worked out at half size: it is smooth, and is compared with heights at full size."""
SHADOW_STEPS = 26
OCCLUDERS = ((4.0, 0.40), (13.0, 0.38), (40.0, 0.42))
"""Reach of what shuts out the sky, px, and how much of it that may shut out."""
LEAST_SKY = 0.15


class Shade(NamedTuple):
    """What stands in the light's way, full size."""

    ceilings: tuple[Image, ...]
    """Under each of these z a point is in the shadow of one part of the light."""
    hulls: tuple[Image, ...]
    """Mean z around, one for each of OCCLUDERS."""
    gain: Image
    """Share of the key that reaches each place."""


def cast_shade(z: Image, light: Light) -> Shade:
    """From the view's z of whatever is seen, (rows, columns)."""
    rows, columns = z.shape
    small = cv2.resize(z, None, fx=HALF, fy=HALF, interpolation=cv2.INTER_AREA)

    def full(image: Image) -> Image:
        return cv2.resize(image, (columns, rows), interpolation=cv2.INTER_LINEAR)

    hulls = tuple(widely_blurred(small, reach * HALF, (columns, rows)) for reach, _ in OCCLUDERS)
    return Shade(tuple(full(c) for c in _ceilings(small, light)), hulls, _gain(rows, columns, light))


def passed(shade: Shade, z: Image, here: tuple[slice, slice], *, softness: float) -> Image:
    """Share of the key that reaches points at z over the pixels ``here``."""
    # The softer the light, the further above the edge of a shadow its last ray passes.
    reach = np.float32(2.0 + 70.0 * softness)
    # And the more of it comes in beneath caps: they hang over, which heights of what is seen do not tell.
    beneath = 0.95 * softness
    free = shade.gain[here] / len(shade.ceilings)
    return sum(clipped((z - ceiling[here]) / reach + 0.5, beneath, 1) for ceiling in shade.ceilings) * free


def open_sky(shade: Shade, z: Image, here: tuple[slice, slice]) -> Image:
    """Share of the sky over it that a point at z sees past what stands around."""
    opened = np.ones_like(z)
    for hull, (width, most) in zip(shade.hulls, OCCLUDERS, strict=True):
        opened -= most * clipped((hull[here] - z) * np.float32(1 / (0.9 * width)), 0, 1)
    return clipped(opened, LEAST_SKY, 1)


def _ceilings(z: Image, light: Light) -> list[Image]:
    """For the light's lower and upper part: the z under which a point lies in its shadow."""
    rows, columns = z.shape
    towards = light.direction[:2] / max(float(np.hypot(*light.direction[:2])), 1e-6)
    slopes = [
        math.tan(min(max(light.elevation + off, 0.1), 1.5))
        for off in (-light.softness / 2, light.softness / 2)
    ]
    ceilings = [np.full_like(z, -1e6) for _ in slopes]
    furthest = min(float(z.max() - z.min()) / slopes[0], 320.0)
    steps = furthest * HALF * (np.arange(1, SHADOW_STEPS + 1) / SHADOW_STEPS) ** 1.5
    for x, y in sorted({(round(float(x)), round(float(y))) for x, y in steps[:, None] * towards}):
        if abs(x) >= columns or abs(y) >= rows:
            continue
        # Whole pixels, so that what stands in the way is a window of the picture and not a copy of it.
        away = np.s_[max(-y, 0) : rows + min(-y, 0), max(-x, 0) : columns + min(-x, 0)]
        there = z[max(y, 0) : rows + min(y, 0), max(x, 0) : columns + min(x, 0)]
        for ceiling, slope in zip(ceilings, slopes, strict=True):
            ceiling[away] = cv2.max(ceiling[away], there - np.float32(math.hypot(x, y) / HALF * slope))
    return ceilings


def _gain(rows: int, columns: int, light: Light) -> Image:
    """Falls off across the picture, away from the light."""
    x = np.linspace(-1, 1, columns, dtype=np.float32)[None]
    y = np.linspace(-1, 1, rows, dtype=np.float32)[:, None] * rows / columns
    away = light.direction[:2] / max(float(np.hypot(*light.direction[:2])), 1e-6)
    towards = x * away[0] + y * away[1]
    return 1 + light.slant * (towards - 0.25)
