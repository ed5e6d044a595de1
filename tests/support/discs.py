"""Drawn photos of bright discs on noise, which the smallest network learns in a minute."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import Circle, polygon_of_shape
from fairyring.model.train.crops import CropConfig
from fairyring.model.train.data import Example
from fairyring.model.train.recipe import Recipe
from tests.support.small_networks import TINY

SIDE = 128
DISCS = (
    ((34.0, 40.0, 17.0), (88.5, 30.2, 22.0), (70.0, 92.0, 25.0), (24.0, 100.0, 12.5)),
    ((40.0, 30.0, 20.0), (96.0, 50.5, 15.0), (50.5, 84.0, 24.0), (106.0, 104.0, 14.0)),
)

RECIPE = Recipe(
    network=TINY,
    crop=CropConfig(side=SIDE, most_rotation_deg=0, most_brightness=0),
    iterations=100,
    batch=2,
    optimiser="adamw",
    rate=2e-3,
    warm_up=10,
    schedule="cosine",
    average=0.9,
    frozen=0,
    validate_every=1000,
)

"""Learns the discs by heart."""

SHORT = replace(RECIPE, crop=CropConfig(side=64), iterations=5, warm_up=2, save_every=2)
"""Learns nothing, in a second."""


def photo_of(discs: tuple[tuple[float, float, float], ...], *, width: int, height: int) -> NDArray[np.uint8]:
    """(height, width, 3): noise, and on it discs that are brighter towards their middles."""
    rng = np.random.default_rng(len(discs))
    photo = rng.normal(60, 12, (height, width, 3))
    y, x = np.mgrid[:height, :width] + 0.5
    for cx, cy, r in discs:
        away = np.hypot(x - cx, y - cy) / r
        photo[away < 1] += (130 - 60 * away[away < 1])[:, None]
    return np.clip(photo, 0, 255).astype(np.uint8)


def drawn_examples(folder: Path) -> list[Example]:
    """Two photos of four discs each, written into the folder."""
    examples = []
    for nth, discs in enumerate(DISCS):
        path = folder / f"discs-{nth}.png"
        cv2.imwrite(str(path), photo_of(discs, width=SIDE, height=SIDE))
        caps = [[polygon_of_shape(Circle(*disc))] for disc in discs]
        examples.append(Example(path=path, width=SIDE, height=SIDE, caps=caps))
    return examples
