"""The paper's augmentations (section 3) on an image and its outlines together, on the fly.

Brightness, horizontal flip, vertical mirror and rotation. The image keeps its size; what a rotation brings in
from outside is black, and what it takes outside is lost to the image but not to the outlines.
"""

from __future__ import annotations

import math

import cv2
import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import (
    Outline,
    Points,
    part_of_points,
    points_of_part,
)

Affine = NDArray[np.float64]
"""Matrix (2, 3) that takes continuous (x, y, 1) before to continuous (x, y) after."""


class Augmentation(Struct, frozen=True, kw_only=True):
    """What is done to one image, in this order: mirrored, turned, brightened."""

    flip_horizontal: bool = False
    """Whether left becomes right."""
    flip_vertical: bool = False
    """Whether top becomes bottom."""
    rotation_deg: float = 0.0
    """Rotation about the image's middle, degrees from +x towards +y."""
    brightness: float = 1.0
    """Factor on every grey level."""


def sample_augmentation(
    rng: np.random.Generator, *, most_rotation_deg: float = 20.0, most_brightness: float = 0.35
) -> Augmentation:
    """A random augmentation: each flip half of the time, rotation and brightness uniform within limits."""
    return Augmentation(
        flip_horizontal=bool(rng.integers(2)),
        flip_vertical=bool(rng.integers(2)),
        rotation_deg=float(rng.uniform(-most_rotation_deg, most_rotation_deg)),
        brightness=float(rng.uniform(1 - most_brightness, 1 + most_brightness)),
    )


def motion_of(augmentation: Augmentation, *, width: int, height: int) -> Affine:
    """The matrix that moves points of an image of this size."""
    angle = math.radians(augmentation.rotation_deg)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    mirror = np.diag(
        [
            -1.0 if augmentation.flip_horizontal else 1.0,
            -1.0 if augmentation.flip_vertical else 1.0,
        ]
    )
    linear = turn @ mirror
    middle = np.array([width / 2, height / 2])
    return np.column_stack([linear, middle - linear @ middle])


def move_image(image: NDArray[np.uint8], motion: Affine, *, width: int, height: int) -> NDArray[np.uint8]:
    """Moves an image (h, w) or (h, w, channels) into one of this size; what comes from outside is black."""
    # OpenCV counts from the first pixel's centre.
    indices = motion.copy()
    indices[:, 2] += motion[:, :2] @ (0.5, 0.5) - 0.5
    moved = cv2.warpAffine(image, indices, (width, height), flags=cv2.INTER_LINEAR)
    return np.asarray(moved, dtype=np.uint8)


def move_points(points: Points, motion: Affine) -> Points:
    """Points (n, 2) where the image takes them."""
    return points @ motion[:, :2].T + motion[:, 2]


def move_outline(outline: Outline, motion: Affine) -> Outline:
    """An outline where the image takes it; it may leave the image."""
    return [part_of_points(move_points(points_of_part(part), motion)) for part in outline]
