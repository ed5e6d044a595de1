"""Turns true visible outlines into what a careless model might have said of them: simulated predictions.

Rims waver by about a pixel, as a network's masks do, over stretches of about ten; caps that are little in
sight are often missed; now and then two neighbours become one, and a patch of soil a cap.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np

from model.geometry import (
    Ellipse,
    GeometryError,
    Outline,
    Points,
    area_of_outline,
    bounds_of_outline,
    part_of_points,
    points_of_part,
    polygon_of_shape,
)
from model.raster import check_outline, mask_of_outline, outline_of_mask

WAVER_PX = 1.1
"""Standard deviation of the rim's wavering."""
STRETCH_PX = 10.0
"""Over which the wavering is correlated."""
TOLERANCE_PX = 0.5
"""How far a vertex may be left out of the wavering rim."""
SMALLEST_PX2 = 40.0
MERGED = 0.03
"""Share of caps that swallow a neighbour."""
FALSE_AN_IMAGE = 1.5


class TrueCap(NamedTuple):
    """What is known of a cap."""

    visible: Outline
    visible_fraction: float


class Simulated(NamedTuple):
    """One simulated prediction."""

    visible: Outline
    score: float


def distort_caps(caps: Sequence[TrueCap], *, width: int, height: int, seed: int) -> list[Simulated]:
    """Simulated predictions of one image; the same seed gives the same ones."""
    rng = np.random.default_rng(seed)
    kept = [cap for cap in caps if rng.random() > _chance_to_miss(cap)]
    said = [
        *_merge_some(kept, rng=rng, width=width, height=height),
        *_invent(rng, width=width, height=height),
    ]
    simulated = []
    for cap in said:
        try:
            wavering = [_waver(points_of_part(part), rng) for part in cap.visible]
            visible = check_outline(
                [_inside(part, width, height) for part in wavering], width=width, height=height
            )
        except GeometryError:
            continue
        if area_of_outline(visible) >= SMALLEST_PX2:
            simulated.append(Simulated(visible, _score(cap, rng)))
    return simulated


def _chance_to_miss(cap: TrueCap) -> float:
    small = area_of_outline(cap.visible) < 4 * SMALLEST_PX2
    return min(1.0, 0.02 + 0.5 * (1 - cap.visible_fraction) ** 2 + 0.3 * small)


def _score(cap: TrueCap, rng: np.random.Generator) -> float:
    return round(float(np.clip(rng.normal(0.6 + 0.35 * cap.visible_fraction, 0.06), 0.05, 0.999)), 3)


def _waver(points: Points, rng: np.random.Generator) -> list[float]:
    """One part, its rim moved along its normals by correlated noise, then thinned to what it needs."""
    rim = _resample(points)
    count = len(rim)
    reach = np.minimum(np.arange(count), count - np.arange(count))
    kernel = np.exp(-0.5 * (reach / STRETCH_PX) ** 2)
    kernel /= np.sqrt((kernel**2).sum())
    noise = np.fft.irfft(np.fft.rfft(rng.standard_normal(count)) * np.fft.rfft(kernel), count)
    along = np.roll(rim, -2, axis=0) - np.roll(rim, 2, axis=0)
    normals = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.maximum(np.hypot(*along.T), 1e-9)[:, None]
    moved = (rim + WAVER_PX * noise[:, None] * normals).astype(np.float32)
    return np.round(part_of_points(cv2.approxPolyDP(moved, TOLERANCE_PX, closed=True)[:, 0]), 2).tolist()


def _resample(points: Points) -> Points:
    """Points one pixel apart along a closed polygon."""
    closed = np.vstack([points, points[:1]])
    length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(closed, axis=0).T))])
    at = np.linspace(0.0, length[-1], max(12, int(length[-1])), endpoint=False)
    return np.stack([np.interp(at, length, closed[:, axis]) for axis in (0, 1)], axis=1)


def _inside(part: list[float], width: int, height: int) -> list[float]:
    return part_of_points(np.clip(points_of_part(part), 0, (width, height)))


def _merge_some(
    caps: Sequence[TrueCap], *, rng: np.random.Generator, width: int, height: int
) -> list[TrueCap]:
    left, said = list(caps), []
    while left:
        cap = left.pop()
        near = [other for other in left if _boxes_touch(cap, other)]
        if near and rng.random() < MERGED:
            other = near[int(rng.integers(len(near)))]
            left.remove(other)
            mask = mask_of_outline([*cap.visible, *other.visible], width=width, height=height)
            closed = cv2.morphologyEx(mask, cv2.MORPH_CLOSE, np.ones((5, 5))).astype(np.uint8)
            cap = TrueCap(outline_of_mask(closed), 0.7)
        said.append(cap)
    return said


def _boxes_touch(one: TrueCap, other: TrueCap) -> bool:
    ax, ay, aw, ah = bounds_of_outline(one.visible)
    bx, by, bw, bh = bounds_of_outline(other.visible)
    return ax < bx + bw and bx < ax + aw and ay < by + bh and by < ay + ah


def _invent(rng: np.random.Generator, *, width: int, height: int) -> list[TrueCap]:
    """Caps where there are none."""
    return [
        TrueCap(
            [polygon_of_shape(Ellipse(rng.uniform(0, width), rng.uniform(0, height), a, 0.8 * a, 0.0))], 0.0
        )
        for a in rng.uniform(8, 22, rng.poisson(FALSE_AN_IMAGE))
    ]
