"""Stalks: from the soil up to the cap, thicker at the foot, as much of them as their cap leaves in sight."""

from __future__ import annotations

import math
from typing import NamedTuple

import cv2
import numpy as np

from fairyring.model.scene.caps import Box, Surface
from fairyring.model.scene.growth import Stand
from fairyring.model.scene.pixels import Image, clipped
from fairyring.model.scene.view import View, project

THICKNESS = (0.42, 0.66)
"""Half the width under the cap, in radii of the cap: least and most, of a grown one."""
BUD = 0.3
"""How much more of them it is of the youngest, whose stalks are as stout as their caps are wide."""


class Stalk(NamedTuple):
    """One stalk in the view."""

    foot: tuple[float, float, float]
    head: tuple[float, float, float]
    """View coordinates; the head is the middle of the cap."""
    wide: float
    """Half its width at the foot, px."""
    narrow: float
    """And under the cap."""


def shape_stalks(stand: Stand, view: View, rng: np.random.Generator) -> list[Stalk]:
    """One a cap, in the caps' order."""
    feet = np.column_stack([stand.foot, np.zeros(len(stand.radius))])
    foot, _, foot_z = project(view, feet)
    head, scale, head_z = project(view, stand.place)
    young = np.clip((50.0 - 2 * stand.radius) / 30.0, 0, 1)
    narrow = stand.radius * scale * (rng.uniform(*THICKNESS, len(scale)) + BUD * young)
    wide = narrow * rng.uniform(1.0, 1.35, len(scale))
    return [
        Stalk(
            (float(foot[i, 0]), float(foot[i, 1]), float(foot_z[i])),
            (float(head[i, 0]), float(head[i, 1]), float(head_z[i])),
            float(wide[i]),
            float(narrow[i]),
        )
        for i in range(len(scale))
    ]


def bounds_of_stalk(stalk: Stalk) -> Box:
    """Whole pixels that hold it."""
    reach = stalk.wide + 2
    xs, ys = (stalk.foot[0], stalk.head[0]), (stalk.foot[1], stalk.head[1])
    return (
        int(np.floor(min(xs) - reach)),
        int(np.floor(min(ys) - reach)),
        int(np.ceil(max(xs) + reach)),
        int(np.ceil(max(ys) + reach)),
    )


def cover_of_stalk(stalk: Stalk, box: Box) -> Image:
    """Share of every pixel of a box that the stalk covers, where nothing lies on it."""
    return _measured(stalk, box).cover


def surface_of_stalk(stalk: Stalk, box: Box) -> Surface:
    """A tapering cylinder with a rounded foot over the pixels of a box."""
    at = _measured(stalk, box)
    side = clipped(at.aside / at.half, -1, 1)
    end = clipped(at.beyond / at.half, -1, 1)
    front = np.sqrt((1 - side * side - end * end).clip(0))

    climb = stalk.head[2] - stalk.foot[2]
    full = math.hypot(at.length, climb)
    steep, level = climb / full, at.length / full
    lean = end - front * steep
    normal = np.stack(
        [
            lean * at.ahead[0] - side * at.ahead[1],
            lean * at.ahead[1] + side * at.ahead[0],
            (front * level + (-end).clip(0) * steep).clip(0.05),
        ]
    )
    return Surface(
        cover=at.cover,
        z=stalk.foot[2] + climb * at.up + at.half * front * level,
        normal=normal,
        skin_x=at.up * full,
        skin_y=np.arcsin(side) * at.half,
        rise=at.up,
    )


class _Measured(NamedTuple):
    """Pixels of a box measured along the line from foot to head, float32 (rows, columns)."""

    ahead: tuple[float, float]
    """Unit vector from foot to head in the image."""
    length: float
    up: Image
    """Part of the way to the head, within [0, 1]."""
    aside: Image
    beyond: Image
    """Past either end, where the stalk closes in the half circle of its own width, px."""
    half: Image
    cover: Image


def _measured(stalk: Stalk, box: Box) -> _Measured:
    left, top, right, bottom = box
    dx = np.arange(left, right, dtype=np.float32)[None] + np.float32(0.5 - stalk.foot[0])
    dy = np.arange(top, bottom, dtype=np.float32)[:, None] + np.float32(0.5 - stalk.foot[1])
    run_x, run_y = stalk.head[0] - stalk.foot[0], stalk.head[1] - stalk.foot[1]
    length = max(math.hypot(run_x, run_y), 1e-3)
    ahead_x, ahead_y = run_x / length, run_y / length
    along = dx * ahead_x + dy * ahead_y
    aside = dy * ahead_x - dx * ahead_y
    up = clipped(along / np.float32(length), 0, 1)
    beyond = along - up * length
    half = stalk.wide + (stalk.narrow - stalk.wide) * up
    cover = clipped(half - cv2.magnitude(aside, beyond) + 0.5, 0, 1)
    return _Measured((ahead_x, ahead_y), length, up, aside, beyond, half, cover)
