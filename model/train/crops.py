"""Augmented crops of photos at native scale, with their caps: section 3's augmentations, on the fly."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from fairyring.model.geometry.ellipse_parameters import moved_parameters, parameters_of
from fairyring.model.geometry.raster import Mask, mask_of_outline
from fairyring.model.geometry.shapes import Outline, Shape, bounds_of_outline
from fairyring.model.network.config import FRAME
from fairyring.model.train.augment import Affine, Augmentation, motion_of, move_image, move_outline

LEAST_VISIBLE = 24
"""A cap with fewer pixels than this in a crop is not learnt there."""


class CropConfig(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The paper's augmentations; what goes beyond them is off unless asked for."""

    side: int = 512
    """Side of a crop, photo pixels; a multiple of ``NetworkConfig.multiple``."""
    most_rotation_deg: float = 20.0
    most_brightness: float = 0.35
    scale: tuple[float, float] = (1.0, 1.0)
    """Range of the enlargement, sampled uniformly in the logarithm."""
    most_gain: float = 0.0
    """Each colour channel is multiplied by a factor between 1 - this and 1 + this."""
    most_gamma: float = 0.0
    """Grey levels get an exponent between 1 - this and 1 + this."""
    most_blur_px: float = 0.0
    """Largest σ of a Gaussian blur, pixels; half of the crops are blurred."""
    most_noise: float = 0.0
    """Largest σ of added noise, grey levels; half of the crops get some."""


@dataclass(frozen=True, kw_only=True)
class Crop:
    """A square piece of an augmented photo. Coordinates are the crop's own."""

    photo: NDArray[np.uint8]
    """(side, side, 3)."""
    origin: tuple[float, float]
    """Where its first corner is said to lie, from the middle of a photo: anywhere a photo may reach, whatever
    this photo's own shape, so that wide and tall ones are learnt alike."""
    masks: NDArray[np.uint8]
    """(n, side, side), 1 on the visible cap."""
    boxes: NDArray[np.float64]
    """(n, 4): x, y, width, height of the masks."""
    centres: NDArray[np.float64]
    """(n, 2): mass centres of the masks."""
    wholes: NDArray[np.float64]
    """(n, 5): the whole ellipses, as in ``model.geometry.ellipse_parameters``; NaN where not known."""
    ignored: NDArray[np.bool_]
    """(side, side) bool: where nothing is learnt."""


def cut_crop(
    photo: NDArray[np.uint8],
    caps: list[Outline],
    ignored: list[Outline],
    *,
    wholes: Sequence[Shape | None] = (),
    complete: bool = True,
    augmentation: Augmentation,
    config: CropConfig,
    rng: np.random.Generator,
) -> Crop:
    """A crop at a random place; outside of the photo it is black.

    Where the caps are not all there are (``complete``), one of them is in the crop, and everything outside
    them is ignored. ``wholes``: the whole outline of each cap where it is known; empty where none is.
    """
    height, width = photo.shape[:2]
    scale = float(np.exp(rng.uniform(*np.log(config.scale))))
    motion = motion_of(augmentation, width=width, height=height) * scale
    extents = (width * scale, height * scale)
    if complete or not caps:
        corner = [_first(extent, config.side, rng) for extent in extents]
    else:
        middle = _middle(move_outline(caps[rng.integers(len(caps))], motion))
        corner = [_first_near(*axis, config.side, rng) for axis in zip(middle, extents, strict=True)]
    motion[:, 2] -= corner
    drawn = [_mask_in(move_outline(outline, motion), config.side) for outline in caps]
    masks = [mask for mask in drawn if mask is not None]
    unlearnt = np.full((config.side, config.side), not complete)
    for mask in masks:
        unlearnt &= mask == 0
    for outline in ignored:
        mask = _mask_in(move_outline(outline, motion), config.side)
        if mask is not None:
            unlearnt |= mask.astype(bool)
    places = np.array([_box_and_mass_centre(mask) for mask in masks], dtype=np.float64).reshape(-1, 6)
    reach = FRAME / 2
    return Crop(
        photo=_photograph(photo, motion, augmentation.brightness, config, rng),
        origin=tuple(rng.uniform(-reach, max(reach - config.side, -reach), 2).tolist()),
        masks=np.stack(masks) if masks else np.zeros((0, config.side, config.side), np.uint8),
        boxes=places[:, :4],
        centres=places[:, 4:],
        wholes=_wholes_in([mask is not None for mask in drawn], wholes, motion),
        ignored=unlearnt,
    )


def _first(extent: float, side: int, rng: np.random.Generator) -> float:
    """First pixel of the crop along one axis: random, or such that a smaller photo is in the middle."""
    room = extent - side
    # Whole pixels, so that a crop that is neither turned nor scaled is as sharp as its photo.
    return float(np.floor(min(rng.uniform(0, room + 1), room) if room > 0 else room / 2))


def _first_near(middle: float, extent: float, side: int, rng: np.random.Generator) -> float:
    """As ``_first``, such that a point of the photo is in the crop."""
    room = extent - side
    if room <= 0:
        return _first(extent, side, rng)
    return float(np.floor(np.clip(rng.uniform(middle - side, middle), 0, room)))


def _middle(outline: Outline) -> tuple[float, float]:
    x, y, width, height = bounds_of_outline(outline)
    return x + width / 2, y + height / 2


def _mask_in(outline: Outline, side: int) -> Mask | None:
    """Mask (side, side) of an outline in the crop; None where fewer than LEAST_VISIBLE pixels are in it."""
    x, y, width, height = bounds_of_outline(outline)
    left, top = max(0, math.floor(x)), max(0, math.floor(y))
    right, bottom = min(side, math.ceil(x + width)), min(side, math.ceil(y + height))
    if left >= right or top >= bottom:
        return None
    window = mask_of_outline(
        move_outline(outline, np.array([[1.0, 0.0, -left], [0.0, 1.0, -top]])),
        height=bottom - top,
        width=right - left,
    )
    if np.count_nonzero(window) < LEAST_VISIBLE:
        return None
    mask = np.zeros((side, side), np.uint8)
    mask[top:bottom, left:right] = window
    return mask


def _wholes_in(drawn: Sequence[bool], wholes: Sequence[Shape | None], motion: Affine) -> NDArray[np.float64]:
    """(n, 5): parameters of the whole outlines of the caps that are drawn in the crop."""
    known = [
        np.full(5, np.nan) if whole is None else moved_parameters(parameters_of(whole), motion)
        for whole, shown in zip(wholes or [None] * len(drawn), drawn, strict=True)
        if shown
    ]
    return np.array(known, np.float64).reshape(-1, 5)


def _box_and_mass_centre(mask: Mask) -> tuple[float, ...]:
    """x, y, width, height of the mask, and x, y of its mass centre."""
    x, y, width, height = cv2.boundingRect(mask)
    moments = cv2.moments(np.ascontiguousarray(mask[y : y + height, x : x + width]), binaryImage=True)
    area = moments["m00"]
    return x, y, width, height, x + moments["m10"] / area + 0.5, y + moments["m01"] / area + 0.5


def _photograph(
    photo: NDArray[np.uint8],
    motion: Affine,
    brightness: float,
    config: CropConfig,
    rng: np.random.Generator,
) -> NDArray[np.uint8]:
    """The crop's pixels, as another camera in another light might have taken them."""
    seen = move_image(photo, motion, width=config.side, height=config.side)
    gains = brightness * rng.uniform(1 - config.most_gain, 1 + config.most_gain, 3)
    gamma = rng.uniform(1 - config.most_gamma, 1 + config.most_gamma)
    levels = 255 * (np.arange(256)[:, None] / 255) ** gamma * gains
    seen = cv2.LUT(seen, np.clip(np.round(levels), 0, 255).astype(np.uint8).reshape(256, 1, 3))
    blur = config.most_blur_px * rng.uniform() * rng.integers(2)
    if blur > 0.2:
        seen = cv2.GaussianBlur(seen, (0, 0), blur)
    noise = config.most_noise * rng.uniform() * rng.integers(2)
    if noise > 0:
        grain = rng.standard_normal(seen.shape, dtype=np.float32) * np.float32(noise)
        seen = np.clip(seen + grain, 0, 255).astype(np.uint8)
    return np.asarray(seen, dtype=np.uint8)
