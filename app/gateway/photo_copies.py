"""Copies of photos that every browser shows: upright, 8 bits, perhaps smaller."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model import photo
from fairyring.storage.records import Image

QUALITY_FULL, QUALITY_SCALED = 95, 88
STEEPEST, TILES = 3.0, (8, 8)
"""How much contrast may grow, and in how many tiles it is measured."""


@dataclass(frozen=True, kw_only=True)
class Wanted:
    """How a copy is to be."""

    width: int | None
    """Pixels; None for the photo's own."""
    local_contrast: bool = False
    """Contrast is evened out from place to place."""


AS_IT_IS = Wanted(width=None)


def photo_copy(source: Path, made: Path, image: Image, wanted: Wanted) -> None:
    """Writes a photo to ``made`` as it is wanted; it is there whole or not at all.

    Raises PhotoError where the photo cannot be read.
    """
    width = wanted.width
    if width is None:
        pixels, quality = photo.read(source), QUALITY_FULL
    else:
        height = max(round(image.height * width / image.width), 1)
        pixels = photo.read(source, longest=max(width, height))
        if pixels.shape[:2] != (height, width):
            pixels = cv2.resize(pixels, (width, height), interpolation=cv2.INTER_AREA)
        quality = QUALITY_SCALED
    if wanted.local_contrast:
        pixels = with_local_contrast(np.asarray(pixels, np.uint8))
    _, encoded = cv2.imencode(".jpg", pixels, [cv2.IMWRITE_JPEG_QUALITY, quality])
    made.parent.mkdir(parents=True, exist_ok=True)
    partial = made.with_suffix(f".{os.getpid()}-{os.urandom(4).hex()}")
    partial.write_bytes(encoded.tobytes())
    partial.replace(made)


def with_local_contrast(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A photo (height, width, 3; BGR) whose lightness is equalised tile by tile (CLAHE); hues stay."""
    lab = cv2.cvtColor(pixels, cv2.COLOR_BGR2LAB)
    lab[:, :, 0] = cv2.createCLAHE(clipLimit=STEEPEST, tileGridSize=TILES).apply(lab[:, :, 0])
    return np.asarray(cv2.cvtColor(lab, cv2.COLOR_LAB2BGR), np.uint8)
