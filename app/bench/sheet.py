"""One sheet of real photos and rendered beds, to look for what gives the rendered ones away."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.errors import FairyringError
from fairyring.model.photo import SUFFIXES, read
from fairyring.model.scene.bed import render_bed
from fairyring.model.scene.presets import PRESETS

TILE = (640, 360)
ACROSS = 4
EACH = 4
"""How many beds of each preset are on the sheet."""

Picture = NDArray[np.uint8]


def draw_sheet(out: Path, *, real: Path | None) -> None:
    """Writes the photos of ``real``/images, if given, and under them sixteen rendered beds as a PNG file.

    Raises FairyringError where the folder holds no photos or ``out`` cannot be written.
    """
    pictures = [*_photos(real), *_beds()] if real else _beds()
    tiles = [_tile(picture) for picture in pictures]
    rows = [np.hstack(tiles[start : start + ACROSS]) for start in range(0, len(tiles), ACROSS)]
    try:
        out.write_bytes(cv2.imencode(".png", np.vstack(rows))[1].tobytes())
    except OSError as error:
        raise FairyringError(f"{out} cannot be written: {error.strerror}.") from error


def _photos(real: Path) -> list[Picture]:
    folder = real / "images"
    files = sorted(folder.iterdir()) if folder.is_dir() else []
    photos = [read(file) for file in files if file.suffix.lower() in SUFFIXES]
    if not photos:
        raise FairyringError(f"There are no photos in {folder}; give a folder with images/.")
    # Rows of photos are filled up, so that the beds begin a row of their own.
    return photos + [np.zeros_like(photos[0])] * (-len(photos) % ACROSS)


def _beds() -> list[Picture]:
    return [
        render_bed(PRESETS[name], seed=1, index=index).image
        for name in ("farm", "mixed", "default", "paper")
        for index in range(EACH)
    ]


def _tile(picture: Picture) -> Picture:
    """The whole picture, scaled to fit a tile and centred on it."""
    width, height = TILE
    factor = min(width / picture.shape[1], height / picture.shape[0])
    small = cv2.resize(picture, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA)
    left, top = (width - small.shape[1]) // 2, (height - small.shape[0]) // 2
    tile = np.zeros((height, width, 3), np.uint8)
    tile[top : top + small.shape[0], left : left + small.shape[1]] = small
    return tile
