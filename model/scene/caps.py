"""The shape of caps: what their outlines are in the image, and their surfaces pixel by pixel.

A cap is two half spheroids joined at the rim, a high one above and a flat one below. Seen from any side its
outline is two half ellipses joined across the tilt. What neighbours and chance do to it stretches every
direction from the middle by a factor of its own, outline and surface alike.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import part_of_points
from fairyring.model.scene.growth import Floats, Stand, pairs_within
from fairyring.model.scene.pixels import Image, clipped
from fairyring.model.scene.settings import Growth
from fairyring.model.scene.view import View, project, turn

Box = tuple[int, int, int, int]
"""left, top, right, bottom in whole pixels; right and bottom are outside."""

ANGLES = 128
"""Directions an outline is kept in: the polygon's vertices. At 100 px its edges sag by 0.03 px."""
DIRECTIONS = np.arange(ANGLES) * (2 * np.pi / ANGLES)
FINE = 2048
"""Directions in which a surface looks its outline up, a power of 2."""


class Cap(NamedTuple):
    """One cap in the view."""

    centre: tuple[float, float, float]
    """The middle of the rim, view coordinates."""
    radius: float
    axis: tuple[float, float, float]
    """Unit vector out of the top, view coordinates."""
    dome: float
    base: float
    """Heights of the upper and the lower half, in radii."""
    outline: Floats
    """(ANGLES,): distance from the centre to the outline, px, from +x towards +y."""


class Surface(NamedTuple):
    """A cap or a stalk over a box of pixels, float32 (rows, columns, ...)."""

    cover: Image
    """Share of the pixel it covers, where nothing lies on it."""
    z: Image
    normal: Image
    """(3, rows, columns), view coordinates, of about unit length."""
    skin_x: Image
    skin_y: Image
    """Place on it, px, as if unrolled."""
    rise: Image
    """Caps: height over the rim in radii, negative below. Stalks: 0 at the foot, 1 at the cap."""


def shape_caps(stand: Stand, view: View, growth: Growth, rng: np.random.Generator) -> list[Cap]:
    """The caps of a stand as the camera sees them, squeezed where they meet."""
    image, scale, z = project(view, stand.place)
    axis = turn(view, stand.place, stand.axis)
    count = len(scale)
    radius = stand.radius * scale
    young = np.clip((60.0 - 2 * stand.radius) / 60.0, 0, 1)
    dome = np.clip(rng.normal(0.80 + 0.12 * young, 0.06), 0.6, 1.05)
    base = np.clip(rng.normal(0.42 + 0.2 * young, 0.05), 0.3, 0.75)
    outline = _egg(axis, dome, base) * radius[:, None] * _wobble(count, growth.irregularity, rng)
    outline = _squeezed(outline, image, z, radius, growth.squeeze)
    return [
        Cap(
            (float(image[i, 0]), float(image[i, 1]), float(z[i])),
            float(radius[i]),
            (float(axis[i, 0]), float(axis[i, 1]), float(axis[i, 2])),
            float(dome[i]),
            float(base[i]),
            outline[i],
        )
        for i in range(count)
    ]


def polygon_of_cap(cap: Cap) -> list[float]:
    """The whole outline as one part, also where it is hidden or outside the image.

    On a grid of 1/256 px, where sums with whole numbers are exact, so that moving it changes no pixel.
    """
    points = cap.outline[:, None] * np.column_stack([np.cos(DIRECTIONS), np.sin(DIRECTIONS)])
    return part_of_points(np.rint((points + cap.centre[:2]) * 256) / 256)


def surface_of_cap(cap: Cap, box: Box) -> Surface:
    """The surface over a box: each pixel's ray meets the upper spheroid or, below the rim, the lower."""
    left, top, right, bottom = box
    dx = np.arange(left, right, dtype=np.float32) + np.float32(0.5 - cap.centre[0])
    dy = np.arange(top, bottom, dtype=np.float32) + np.float32(0.5 - cap.centre[1])
    dx, dy = np.meshgrid(dx, dy)
    distance, angle = cv2.cartToPolar(dx, dy)
    index = (angle * np.float32(FINE / (2 * np.pi))).astype(np.intp) & (FINE - 1)
    outline = _fine(cap.outline)
    egg = _fine(_egg(np.array([cap.axis]), np.array([cap.dome]), np.array([cap.base]))[0])
    reach, shrink = outline[index], (egg / outline)[index]

    sine = math.hypot(cap.axis[0], cap.axis[1])
    cosine = max(cap.axis[2], 0.05)
    toward_x, toward_y = (cap.axis[0] / sine, cap.axis[1] / sine) if sine > 1e-6 else (1.0, 0.0)
    along = (dx * toward_x + dy * toward_y) * shrink
    across = (dy * toward_x - dx * toward_y) * shrink

    depth, flat = _depth(along, across, sine, cosine, cap.dome), np.float32(cap.dome)
    up = along * sine + depth * cosine
    if up.min() < 0:
        is_dome = up >= 0
        depth = np.where(is_dome, depth, _depth(along, across, sine, cosine, cap.base))
        flat = np.where(is_dome, flat, np.float32(cap.base))
        up = along * sine + depth * cosine
    out = along * cosine - depth * sine

    steep = up / (flat * flat)
    tilt = out * cosine + steep * sine
    normal = np.stack(
        [
            tilt * toward_x - across * toward_y,
            tilt * toward_y + across * toward_x,
            (steep * cosine - out * sine).clip(0.02),
        ]
    )
    size = np.float32(cap.radius)
    return Surface(
        cover=clipped(reach - distance + 0.5, 0, 1),
        z=np.float32(cap.centre[2]) + depth * size,
        normal=normal,
        skin_x=out * size,
        skin_y=across * size,
        rise=up,
    )


def _depth(along: Image, across: Image, sine: float, cosine: float, flat: float) -> Image:
    """z where rays down the view first meet a unit spheroid of half height ``flat``, tilted along."""
    a = sine**2 + cosine**2 / flat**2
    b = along * (sine * cosine * (1 / flat**2 - 1))
    c = along**2 * (cosine**2 + sine**2 / flat**2) + across**2 - 1
    return (np.sqrt((b * b - a * c).clip(0)) - b) / np.float32(a)


def _egg(axis: Floats, dome: Floats, base: Floats) -> Floats:
    """(n, ANGLES): outlines in radii, from axes (n, 3) and half heights (n,)."""
    sine2 = axis[:, 0] ** 2 + axis[:, 1] ** 2
    turned = DIRECTIONS[None] - np.arctan2(axis[:, 1], axis[:, 0])[:, None]
    towards = np.cos(turned)
    flat = np.where(towards > 0, dome[:, None], base[:, None])
    half = (1 - sine2)[:, None] + flat**2 * sine2[:, None]
    return 1 / np.sqrt(towards**2 / half + np.sin(turned) ** 2)


def _wobble(count: int, irregularity: float, rng: np.random.Generator) -> Floats:
    """(count, ANGLES) factors near 1: ovals first, then ever smaller lobes."""
    factor = np.ones((count, ANGLES))
    for lobes, size in ((2, 0.075), (3, 0.028), (4, 0.016), (5, 0.01), (7, 0.005)):
        amount = irregularity * size * rng.standard_normal((count, 1))
        factor += amount * np.cos(lobes * DIRECTIONS + rng.uniform(0, 2 * np.pi, (count, 1)))
    return factor


def _squeezed(outline: Floats, centre: Floats, z: Floats, radius: Floats, squeeze: float) -> Floats:
    """Outlines with flat contacts where caps of like height meet; ``squeeze`` 1 leaves no overlap there."""
    limits = outline.copy()
    for first, second in zip(*pairs_within(centre, 1.1 * radius), strict=True):
        level = np.exp(-(((z[first] - z[second]) / (0.45 * (radius[first] + radius[second]))) ** 2))
        offset = centre[second] - centre[first]
        apart = max(float(np.hypot(*offset)), 1e-6)
        heading = np.arctan2(offset[1], offset[0])
        reach = _along(outline[first], heading), _along(outline[second], heading + np.pi)
        overlap = reach[0] + reach[1] - apart
        if overlap <= 0:
            continue
        give = squeeze * level
        for cap, direction, own in ((first, heading, reach[0]), (second, heading + np.pi, reach[1])):
            plane = max(own - overlap * own / (reach[0] + reach[1]), 0.5 * own)
            facing = np.cos(DIRECTIONS - direction)
            border = plane / np.maximum(facing, 0.05)
            allowed = outline[cap] - give * np.maximum(outline[cap] - border, 0)
            limits[cap] = np.minimum(limits[cap], allowed)
    return _rounded(limits)


def _rounded(outline: Floats) -> Floats:
    """Corners of flat contacts taken off: a circular blur over about 8 degrees."""
    lobes = np.arange(ANGLES // 2 + 1)
    keep = np.exp(-0.5 * (lobes * np.radians(4.0)) ** 2)
    return np.fft.irfft(np.fft.rfft(outline, axis=1) * keep, n=ANGLES, axis=1)


def _along(outline: Floats, angle: float) -> float:
    return float(outline[round(angle / (2 * np.pi) * ANGLES) % ANGLES])


def _fine(outline: Floats) -> NDArray[np.float32]:
    """(FINE,): an outline between the kept directions, linearly."""
    closed = np.append(outline, outline[0])
    return np.interp(_FINE_PLACES, _KEPT_PLACES, closed).astype(np.float32)


_FINE_PLACES = (np.arange(FINE) + 0.5) * (ANGLES / FINE)
_KEPT_PLACES = np.arange(ANGLES + 1.0)
