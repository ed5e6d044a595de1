"""The paper's three light sources (Figure 4), the shade they leave, and the light that comes back."""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from model.scene.caps import Box
from model.scene.pixels import Image, tinted
from model.scene.settings import LightSource

HALF = 0.5
"""Shade is worked out at half size: it is smooth, and is compared with heights at full size."""
SHADOW_STEPS = 26
OCCLUDERS = ((4.0, 0.40), (13.0, 0.38), (40.0, 0.42))
"""Reach of what shuts out the sky, px, and how much of it that may shut out."""


FLESH = np.array([0.66, 0.78, 0.80], np.float32)
"""What caps send on of the light that falls on them."""
FLESH_REACH = 22.0


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
    azimuth, lift, warmth, slant, power, nearness = rng.random(6).tolist()
    elevation = np.radians({"top": 58 + 26 * lift, "side": 17 + 17 * lift, "dark": 40 + 40 * lift}[source])
    level = {"top": 0.66 + 0.12 * power, "side": 0.85 + 0.3 * power, "dark": 0.17 + 0.13 * power}[source]
    sky = {"top": 0.30, "side": 0.10 + 0.06 * power, "dark": 0.10}[source]
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
        dimness={"top": 1.0, "side": 1.3, "dark": 3.5}[source],
    )


def cast_shade(z: Image, flesh: NDArray[np.bool_], light: Light) -> Shade:
    """From the view's z of whatever is seen, and where that is cap or stalk: (rows, columns)."""
    rows, columns = z.shape
    small = cv2.resize(z, None, fx=HALF, fy=HALF, interpolation=cv2.INTER_AREA)

    def full(image: Image) -> Image:
        return cv2.resize(image, (columns, rows), interpolation=cv2.INTER_LINEAR)

    hulls = tuple(full(_blurred(small, reach * HALF)) for reach, _ in OCCLUDERS)
    pale = cv2.resize(flesh.astype(np.float32), None, fx=HALF, fy=HALF, interpolation=cv2.INTER_AREA)
    around = full(_blurred(pale, FLESH_REACH * HALF))
    return Shade(tuple(full(c) for c in _ceilings(small, light)), hulls, _gain(rows, columns, light), around)


def shine(
    colour: Image, normal: Image, z: Image, *, box: Box, light: Light, shade: Shade, glow: float
) -> Image:
    """Light that reaches the camera from a surface over the pixels of a box: (rows, columns, 3), linear.

    ``glow`` is how far light creeps under the surface and round its edges: 0 for soil, about 0.3 for flesh.
    """
    left, top, right, bottom = box
    here = np.s_[top:bottom, left:right]
    x, y, up = light.direction
    facing = normal[..., 0] * x + normal[..., 1] * y + normal[..., 2] * up
    lit = np.clip((facing + glow) / (1 + glow), 0, None)
    # The softer the light, the further above the edge of a shadow its last ray passes.
    reach = 2.0 + 70.0 * light.softness
    blocked = sum(np.clip((ceiling[here] - z) / reach + 0.5, 0, 1) for ceiling in shade.ceilings)
    nearer = 1 + 2 * np.clip(z, -50, 300) / light.height
    direct = lit * (1 - blocked / len(shade.ceilings)) * shade.gain[here] * nearer

    closed = sum(
        most * np.clip((hull[here] - z) / (0.9 * size), 0, 1)
        for hull, (size, most) in zip(shade.hulls, OCCLUDERS, strict=True)
    )
    opened = 1 - np.minimum(closed, 0.97)
    sky = opened * (0.2 + 0.8 * normal[..., 2])
    # Where caps shut out the sky their own light comes in its place, creamier with every bounce.
    fill = (1 - opened * (0.6 + 0.4 * normal[..., 2])) * shade.flesh[here] * shade.gain[here]
    deep = np.clip(closed * 1.6 - 0.35, 0, 1)
    bounce = 0.62 * up * fill
    return colour * (
        tinted(direct, light.key)
        + tinted(bounce * (1 - deep), light.key * FLESH)
        + tinted(bounce * deep, light.key * FLESH * FLESH * np.float32(0.9))
        + tinted(sky, light.sky)
    )


def _ceilings(z: Image, light: Light) -> list[Image]:
    """For the light's lower and upper part: the z under which a point lies in its shadow."""
    away = light.direction[:2] / max(float(np.hypot(*light.direction[:2])), 1e-6)
    slopes = [
        np.tan(np.clip(light.elevation + off, 0.1, 1.5)) for off in (-light.softness / 2, light.softness / 2)
    ]
    ceilings = [np.full_like(z, -1e6) for _ in slopes]
    highest = float(z.max() - z.min())
    furthest = min(highest / slopes[0], 320.0)
    for step in range(1, SHADOW_STEPS + 1):
        distance = furthest * (step / SHADOW_STEPS) ** 1.5
        shift = away * distance * HALF
        move = np.array([[1, 0, shift[0]], [0, 1, shift[1]]], np.float32)
        flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
        seen = cv2.warpAffine(z, move, z.shape[::-1], flags=flags, borderMode=cv2.BORDER_REPLICATE)
        for ceiling, slope in zip(ceilings, slopes, strict=True):
            np.maximum(ceiling, seen - np.float32(distance * slope), out=ceiling)
    return ceilings


def _blurred(z: Image, reach: float) -> Image:
    """A wide blur by way of a smaller picture."""
    if reach < 4:
        return cv2.GaussianBlur(z, (0, 0), reach)
    factor = 2.0 / reach
    small = cv2.resize(z, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA)
    blurred = cv2.GaussianBlur(small, (0, 0), 2.0)
    return cv2.resize(blurred, z.shape[::-1], interpolation=cv2.INTER_CUBIC)


def _gain(rows: int, columns: int, light: Light) -> Image:
    """Falls off across the picture, away from the light."""
    x = np.linspace(-1, 1, columns, dtype=np.float32)[None]
    y = np.linspace(-1, 1, rows, dtype=np.float32)[:, None] * rows / columns
    away = light.direction[:2] / max(float(np.hypot(*light.direction[:2])), 1e-6)
    towards = x * away[0] + y * away[1]
    return 1 + light.slant * (towards - 0.25)
