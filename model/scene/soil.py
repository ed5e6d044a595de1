"""The casing soil: clods of peat, mycelium in strands and clumps, pinheads, litter, the bed's edge."""

from __future__ import annotations

import math
from typing import NamedTuple

import cv2
import numpy as np

from fairyring.model.scene import textures
from fairyring.model.scene.growth import Floats
from fairyring.model.scene.layers import strips, window
from fairyring.model.scene.pixels import Image, clipped, lay_over, planes, step, tinted
from fairyring.model.scene.settings import Soil
from fairyring.model.scene.view import Ground, View, project

PEAT = np.array([0.0200, 0.0165, 0.0160], np.float32)
LOAM = np.array([0.022, 0.034, 0.050], np.float32)
MYCELIUM = np.array([0.66, 0.61, 0.60], np.float32)
PINHEAD = np.array([0.76, 0.76, 0.75], np.float32)
STRAW = np.array([0.06, 0.16, 0.28], np.float32)
ROOT = np.array([0.008, 0.013, 0.02], np.float32)
CRUMB_REACH = 70.0
"""Pinheads stand about this far around the feet of grown caps, px."""


class Bare(NamedTuple):
    """The bed without caps: colour and normals (3, rows, columns), view z (rows, columns)."""

    colour: Image
    z: Image
    normal: Image


class Sowing(NamedTuple):
    """What was drawn for the soil of one image."""

    brightness: float
    mycelium: float
    pinheads: float
    edge: tuple[float, float] | None
    """x of the bed's edge on the bed, and which side is off it: -1 left, 1 right."""


def draw_sowing(soil: Soil, *, width: int, rng: np.random.Generator) -> Sowing:
    """One image's soil."""
    has_edge, side, depth = rng.random(3)
    away = width * (0.04 + 0.1 * depth)
    edge = ((away, -1.0) if side < 0.5 else (width - away, 1.0)) if has_edge < soil.edge else None
    return Sowing(
        rng.uniform(*soil.brightness), rng.uniform(*soil.mycelium), rng.uniform(*soil.pinheads), edge
    )


def lay_soil(
    soil: Soil, sowing: Sowing, *, ground: Ground, view: View, feet: Floats, rng: np.random.Generator
) -> Bare:
    """The soil in the picture; ``feet`` (n, 2) are where caps stand on it."""
    # Rows of the picture stay nearly rows of the tiles, which memory likes; upside down is another bed too.
    turn = rng.uniform(-0.2, 0.2) + np.pi * rng.integers(2)
    place = _Wander(turn, *rng.uniform(0, textures.SIZE, 2).tolist())
    near = _nearness(feet, view)
    colour = np.empty((3, view.height, view.width), np.float32)
    height = np.empty((view.height, view.width), np.float32)
    for box in strips(view.height, view.width):
        here = window(box)
        x, y = place.of(ground.x[here], ground.y[here])
        colour[:, *here], height[here] = _earth(soil, sowing, x, y, near[here])
        if sowing.edge is not None:
            _end_bed(colour[:, *here], height[here], ground.x[here], edge=sowing.edge)
    _scatter_litter(colour, height, count=int(rng.poisson(soil.litter)), rng=rng)
    return Bare(colour, ground.z + height, _normals(height))


class _Wander(NamedTuple):
    """Where on the tiles a bed lies."""

    angle: float
    x: float
    y: float

    def of(self, x: Image, y: Image) -> tuple[Image, Image]:
        """Places on the tiles of places on the bed."""
        cosine, sine = math.cos(self.angle), math.sin(self.angle)
        return x * cosine - y * sine + self.x, x * sine + y * cosine + self.y


def _earth(soil: Soil, sowing: Sowing, x: Image, y: Image, near: Image) -> tuple[Image, Image]:
    """Colour and height of soil, mycelium and pinheads at places on the tiles."""
    relief, cloud, grain, strands = textures.look_up_each(textures.earth(), x, y)
    # Elsewhere on its tile, so that the two do not repeat together.
    fluff, wisps, rise, rank = textures.look_up_each(textures.cover(), x + 389, y + 611)
    earth = PEAT + (LOAM - PEAT) * np.float32(sowing.brightness)
    colour = tinted(clipped(1.0 + 0.4 * relief + 0.15 * grain + 0.35 * cloud, 0.1, 4), earth)
    height = 0.5 * soil.relief * relief + 0.5 * grain

    region = 0.5 * cloud + 0.35 * near
    white = _mycelium(region, fluff, wisps, strands, amount=sowing.mycelium)
    lay_over(colour, tinted(0.75 + 0.15 * grain + 0.1 * fluff, MYCELIUM), white)
    height += white * (2.0 + 1.5 * fluff)

    # A clump needs a region of its own richness, so that they thin out instead of being cut off.
    rich = 1.8 * sowing.pinheads - 1.35 + 0.6 * cloud + 0.9 * near
    least = 0.9 * rank + 20 * max(0.0, 0.1 - sowing.pinheads)
    shown = np.where(rich > least, rise, 0)
    share = clipped(2 * shown, 0, 1)
    lay_over(colour, (0.95 + 0.3 * rank - 0.06 * fluff) * planes(PINHEAD), share)
    return colour, height + 0.9 * shown


def _nearness(feet: Floats, view: View) -> Image:
    """1 where many caps stand, falling to 0 away from them."""
    coarse = 8
    image, _, _ = project(view, np.column_stack([feet, np.zeros(len(feet))]))
    small = np.zeros((-(-view.height // coarse), -(-view.width // coarse)), np.float32)
    for x, y in image / coarse:
        cv2.circle(small, (round(float(x)), round(float(y))), 2, 1.0, -1)
    blurred = cv2.GaussianBlur(small, (0, 0), CRUMB_REACH / coarse / 2)
    near = np.clip(3 * blurred, 0, 1)
    return cv2.resize(near, (view.width, view.height), interpolation=cv2.INTER_LINEAR)


def _mycelium(region: Image, fluff: Image, wisps: Image, strands: Image, *, amount: float) -> Image:
    """Share of white: strands everywhere a little, felted to clumps in some regions."""
    rich = clipped(1.6 * amount - 0.75 + region, 0, 1)
    clump = clipped((fluff + 2.2 * rich - 1.5) * 1.1, 0, 1)
    web = cv2.max(strands, 0.8 * wisps) * clipped(0.25 * amount + 1.2 * rich, 0, 1)
    white = cv2.max(0.9 * web, clump * (0.3 + 0.8 * wisps + 0.6 * strands))
    return step(0.12, 0.85, white) * np.float32(min(0.95, 8 * amount))


def _scatter_litter(colour: Image, height: Image, *, count: int, rng: np.random.Generator) -> None:
    """Straws and roots, drawn over the soil."""
    rows, columns = height.shape
    for _ in range(count):
        start = rng.uniform((0, 0), (columns, rows))
        heading = rng.uniform(0, 2 * np.pi) + np.cumsum(rng.normal(0, 0.25, 6))
        steps = rng.uniform(4, 16) * np.stack([np.cos(heading), np.sin(heading)], axis=1)
        line = np.rint(16 * (start + np.vstack([[0, 0], np.cumsum(steps, axis=0)]))).astype(np.int32)
        thick = int(rng.integers(1, 4))
        tone = (STRAW if rng.random() < 0.4 else ROOT) * rng.uniform(0.5, 1.3)
        for plane, part in zip(colour, tone.tolist(), strict=True):
            cv2.polylines(plane, [line], False, part, thick, cv2.LINE_8, 4)
        raised = np.zeros_like(height[:1, :1])
        left, top = np.maximum(line.min(axis=0) // 16 - 4, 0)
        right, bottom = line.max(axis=0) // 16 + 5
        window = height[top:bottom, left:right]
        if window.size:
            raised = np.zeros_like(window)
            cv2.polylines(
                raised, [line - 16 * np.array([left, top])], False, 2.0 + thick, thick, cv2.LINE_8, 4
            )
            window += raised


def _end_bed(colour: Image, height: Image, x: Image, *, edge: tuple[float, float]) -> None:
    """Beyond the edge: the worn board that holds the soil, and the dark aisle."""
    where, side = edge
    beyond = (x - where) * side + 0.3 * height
    board = (beyond > 0) & (beyond < 12)
    colour[:, board] = PEAT[:, None] + LOAM[:, None] * (0.3 + 0.06 * np.abs(height[board]))
    colour *= np.where(beyond >= 12, np.float32(0.04), np.float32(1))
    height -= np.clip(beyond, 0, 60)


def _normals(height: Image) -> Image:
    slope_x = cv2.Sobel(height, cv2.CV_32F, 1, 0, ksize=3, scale=-1 / 8)
    slope_y = cv2.Sobel(height, cv2.CV_32F, 0, 1, ksize=3, scale=-1 / 8)
    return np.stack([slope_x, slope_y, np.ones_like(height)])
