"""Copies of photos that every browser shows: upright, 8 bits, perhaps smaller."""

from __future__ import annotations

import os
from pathlib import Path

import cv2

from fairyring.model import photo
from fairyring.storage.records import Image

QUALITY_FULL, QUALITY_SCALED = 95, 88


def photo_copy(source: Path, made: Path, image: Image, width: int | None) -> None:
    """Writes a photo to ``made``, at its full size or so many pixels wide; it is there whole or not at all.

    Raises PhotoError where the photo cannot be read.
    """
    if width is None:
        pixels, quality = photo.read(source), QUALITY_FULL
    else:
        height = max(round(image.height * width / image.width), 1)
        pixels = photo.read(source, longest=max(width, height))
        if pixels.shape[:2] != (height, width):
            pixels = cv2.resize(pixels, (width, height), interpolation=cv2.INTER_AREA)
        quality = QUALITY_SCALED
    _, encoded = cv2.imencode(".jpg", pixels, [cv2.IMWRITE_JPEG_QUALITY, quality])
    made.parent.mkdir(parents=True, exist_ok=True)
    partial = made.with_suffix(f".{os.getpid()}-{os.urandom(4).hex()}")
    partial.write_bytes(encoded.tobytes())
    partial.replace(made)
