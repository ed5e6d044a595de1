"""Stalks: from the soil up to the cap, thicker at the foot, as much of them as their cap leaves in sight."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from model.scene.caps import Box, Surface
from model.scene.growth import Stand
from model.scene.view import View, project

THICKNESS = (0.36, 0.52)
"""Half the width under the cap, in radii of the cap: least and most."""


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
    narrow = stand.radius * scale * rng.uniform(*THICKNESS, len(scale))
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


def surface_of_stalk(stalk: Stalk, box: Box) -> Surface:
    """A tapering cylinder with a rounded foot over the pixels of a box."""
    left, top, right, bottom = box
    dx = np.arange(left, right, dtype=np.float32)[None] + np.float32(0.5 - stalk.foot[0])
    dy = np.arange(top, bottom, dtype=np.float32)[:, None] + np.float32(0.5 - stalk.foot[1])
    run = np.subtract(stalk.head, stalk.foot)
    length = max(float(np.hypot(run[0], run[1])), 1e-3)
    ahead_x, ahead_y = run[0] / length, run[1] / length
    along = (dx * ahead_x + dy * ahead_y) / length
    aside = dy * ahead_x - dx * ahead_y

    climb = np.clip(along, 0, 1)
    half = stalk.wide + (stalk.narrow - stalk.wide) * climb
    # Past the foot and the head the cylinder ends in the half circle of its own width.
    beyond = (along - climb) * length
    off = np.hypot(aside, beyond)
    side = np.clip(aside / half, -1, 1)
    end = np.clip(beyond / half, -1, 1)
    front = np.sqrt(np.maximum(1 - side**2 - end**2, 0))

    steep = float(run[2]) / float(np.linalg.norm(run))
    level = length / float(np.linalg.norm(run))
    lean = end - front * steep
    normal = np.dstack(
        [
            lean * ahead_x - side * ahead_y,
            lean * ahead_y + side * ahead_x,
            np.maximum(front * level + np.maximum(-end, 0) * steep, 0.05),
        ]
    )
    normal /= np.sqrt((normal * normal).sum(axis=2, keepdims=True))
    return Surface(
        cover=np.clip(half - off + 0.5, 0, 1).astype(np.float32),
        z=(stalk.foot[2] + run[2] * climb + half * front * level).astype(np.float32),
        normal=normal.astype(np.float32),
        skin_x=(along * np.linalg.norm(run)).astype(np.float32),
        skin_y=(np.arcsin(side) * half).astype(np.float32),
        rise=climb.astype(np.float32),
    )
