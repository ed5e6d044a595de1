"""The paper's three light sources (Figure 4), the shade they leave, and the light that comes back."""

from __future__ import annotations

import math
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.light_and_form import LightSource
from fairyring.model.scene.caps import Box
from fairyring.model.scene.pixels import Image, clipped, tinted

HALF = 0.5
"""Shade is worked out at half size: it is smooth, and is compared with heights at full size."""
SHADOW_STEPS = 26
OCCLUDERS = ((4.0, 0.40), (13.0, 0.38), (40.0, 0.42))
"""Reach of what shuts out the sky, px, and how much of it that may shut out."""
FLESH = np.array([0.68, 0.775, 0.79], np.float32)
"""What caps send on of the light that falls on them."""
FLESH_REACH = 22.0
BOUNCE = 0.5
DEEP = 24.0
"""How far below the caps around it their light is all a place gets, px."""
GLOW = 0.10
"""How far light creeps under the surface of flesh and round its edges."""


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


class Shade(NamedTuple):
    """What stands in the light's way, full size."""

    ceilings: tuple[Image, ...]
    """Under each of these z a point is in the shadow of one part of the light."""
    hulls: tuple[Image, ...]
    """Mean z around, one for each of OCCLUDERS."""
    gain: Image
    """Share of the key that reaches each place."""
    flesh: Image
    """Share of caps and stalks in what is around."""


def draw_light(source: LightSource, rng: np.random.Generator) -> Light:
    """A light of one of the three kinds."""
    azimuth, lift, warmth, slant, power, nearness, gloss = rng.random(7).tolist()
    elevation = np.radians({"top": 50 + 28 * lift, "side": 17 + 17 * lift, "dark": 40 + 40 * lift}[source])
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
        softness={"top": 0.22, "side": 0.07, "dark": 0.20}[source],
        slant={"top": 0.1 + 0.2 * slant, "side": 0.3 + 0.3 * slant, "dark": 0.4}[source],
        height=700 + 700 * nearness,
        gloss=0.15 * gloss,
        dimness={"top": 1.0, "side": 1.3, "dark": 3.5}[source],
    )


def cast_shade(z: Image, flesh: NDArray[np.bool_], light: Light) -> Shade:
    """From the view's z of whatever is seen, and where that is cap or stalk: (rows, columns)."""
    rows, columns = z.shape
    small = cv2.resize(z, None, fx=HALF, fy=HALF, interpolation=cv2.INTER_AREA)

    def full(image: Image) -> Image:
        return cv2.resize(image, (columns, rows), interpolation=cv2.INTER_LINEAR)

    hulls = tuple(_blurred(small, reach * HALF, (columns, rows)) for reach, _ in OCCLUDERS)
    pale = cv2.resize(flesh.astype(np.float32), None, fx=HALF, fy=HALF, interpolation=cv2.INTER_AREA)
    around = _blurred(pale, FLESH_REACH * HALF, (columns, rows))
    return Shade(tuple(full(c) for c in _ceilings(small, light)), hulls, _gain(rows, columns, light), around)


def shine(colour: Image, normal: Image, z: Image, *, box: Box, light: Light, shade: Shade) -> Image:
    """Light that reaches the camera from surfaces over the pixels of a box: (3, rows, columns), linear.

    Normals need not be of unit length.
    """
    left, top, right, bottom = box
    here = np.s_[top:bottom, left:right]
    x, y, up = light.direction
    across, along, level = normal
    size = 1 / np.sqrt(across * across + along * along + level * level)
    level = level * size
    facing = (across * x + along * y) * size + level * up
    lit = clipped((facing + GLOW) * np.float32(1 / (1 + GLOW)), 0, 1)
    # A moist skin mirrors the light half way between it and the camera, softly.
    mirrored = clipped((facing + level) * np.float32(1 / math.sqrt(2 + 2 * up)), 0, 1)
    for _ in range(4):
        mirrored *= mirrored
    lit += light.gloss * mirrored

    # The softer the light, the further above the edge of a shadow its last ray passes.
    reach = np.float32(2.0 + 70.0 * light.softness)
    free = shade.gain[here] / len(shade.ceilings)
    passed = sum(clipped((z - ceiling[here]) / reach + 0.5, 0, 1) for ceiling in shade.ceilings) * free
    nearer = 1 + clipped(z * np.float32(2 / light.height), -100 / light.height, 600 / light.height)
    direct = lit * passed * nearer

    opened = np.ones_like(z)
    for hull, (width, most) in zip(shade.hulls, OCCLUDERS, strict=True):
        opened -= most * clipped((hull[here] - z) * np.float32(1 / (0.9 * width)), 0, 1)
    clipped(opened, 0.03, 1)
    sky = opened * (0.2 + 0.8 * level)
    # Down between caps their own light comes in the sky's place, creamy from the bounce; a rim that stands
    # over its surroundings gets none of it.
    fill = clipped((shade.hulls[-1][here] - z) * np.float32(1 / DEEP), 0, 1)
    fill *= shade.flesh[here] * shade.gain[here]
    bounced = light.key * FLESH * np.float32(BOUNCE * up)
    return colour * (tinted(direct, light.key) + tinted(fill, bounced) + tinted(sky, light.sky))


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


def _blurred(z: Image, reach: float, size: tuple[int, int]) -> Image:
    """A wide blur by way of a smaller picture, at (columns, rows) of its own."""
    factor = min(2.0 / reach, 1.0)
    small = cv2.resize(z, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA)
    return cv2.resize(cv2.GaussianBlur(small, (0, 0), reach * factor), size, interpolation=cv2.INTER_LINEAR)


def _gain(rows: int, columns: int, light: Light) -> Image:
    """Falls off across the picture, away from the light."""
    x = np.linspace(-1, 1, columns, dtype=np.float32)[None]
    y = np.linspace(-1, 1, rows, dtype=np.float32)[:, None] * rows / columns
    away = light.direction[:2] / max(float(np.hypot(*light.direction[:2])), 1e-6)
    towards = x * away[0] + y * away[1]
    return 1 + light.slant * (towards - 0.25)
