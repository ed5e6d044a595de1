"""Draws the pictures of docs/beds.md: `python docs/draw_beds.py`."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import points_of_part
from fairyring.model.light_and_form import FORMS, LightSource
from fairyring.model.scene.bed import Bed, render_bed
from fairyring.model.scene.presets import preset
from fairyring.model.scene.settings import changed

OUT = Path(__file__).parent / "beds"
THUMB = (432, 243)
SEED = 3
CLUSTER = np.s_[130:350, 450:740]
WHITE, YELLOW, RED = (255, 255, 255), (0, 220, 255), (60, 60, 255)

Picture = NDArray[np.uint8]


def forms_by_light() -> Picture:
    """One row a form, one column a light."""
    rows = []
    for row, form in enumerate(FORMS):
        beds = [_bed(form, light, index=3 * row + column) for column, light in enumerate(LightSource)]
        rows.append(np.hstack([_thumb(bed) for bed in beds]))
    return np.vstack(rows)


def farm() -> Picture:
    """A bed of preset farm at full size."""
    return render_bed(preset("farm"), seed=SEED, index=4).image


def mixed() -> Picture:
    """Six beds of preset mixed."""
    beds = [render_bed(preset("mixed"), seed=SEED, index=index).image for index in (0, 1, 3, 8, 9, 10)]
    small = [cv2.resize(bed, THUMB, interpolation=cv2.INTER_AREA) for bed in beds]
    return np.asarray(np.vstack([np.hstack(small[:3]), np.hstack(small[3:])]), np.uint8)


def rims() -> Picture:
    """A cluster at three times its size without and with what softens its rims."""
    hard = {"flesh": {"interreflection": [0, 0], "translucency": [0, 0]}, "camera": {"defocus": 0}}
    hard |= {"growth": {"fused": [0, 0]}}
    plain = changed(preset("farm"), {"flesh": {"translucency": [1.6, 1.6]}, "growth": {"fused": [0.7, 0.7]}})
    beds = [render_bed(settings, seed=SEED, index=4).image for settings in (changed(plain, hard), plain)]
    crops = [cv2.resize(bed[*CLUSTER], None, fx=3, fy=3, interpolation=cv2.INTER_CUBIC) for bed in beds]
    return np.asarray(np.hstack(crops), np.uint8)


def truth() -> Picture:
    """Half of a bed at twice its size with what is known of it: visible and whole outlines, and centres."""
    bed = _bed("d", LightSource.top, index=12)
    picture = cv2.resize(bed.image, None, fx=2, fy=2, interpolation=cv2.INTER_CUBIC)
    for cap in bed.caps:
        _draw(picture, [cap.whole], RED)
        _draw(picture, cap.visible, YELLOW)
        centre = tuple(round(32 * value) for value in cap.centre)
        cv2.circle(picture, centre, 3 * 16, RED, -1, cv2.LINE_AA, 4)
    return np.asarray(picture[100:900, 300:1740], np.uint8)


def _bed(form: str, light: LightSource, *, index: int) -> Bed:
    return render_bed(replace(preset("default"), forms=(form,), lights=(light,)), seed=SEED, index=index)


def _thumb(bed: Bed) -> Picture:
    small = cv2.resize(bed.image, THUMB, interpolation=cv2.INTER_AREA)
    cv2.putText(small, f"({bed.form}) {bed.light}", (8, 20), 0, 0.55, (0, 0, 0), 4, cv2.LINE_AA)
    cv2.putText(small, f"({bed.form}) {bed.light}", (8, 20), 0, 0.55, WHITE, 1, cv2.LINE_AA)
    return np.asarray(small, np.uint8)


def _draw(picture: cv2.typing.MatLike, outline: list[list[float]], colour: tuple[int, int, int]) -> None:
    """On a picture of twice the size; the centre of OpenCV's first pixel is 0."""
    lines = [np.rint((2 * points_of_part(part) - 0.5) * 16).astype(np.int32) for part in outline]
    cv2.polylines(picture, lines, True, colour, 2, cv2.LINE_AA, 4)


if __name__ == "__main__":
    OUT.mkdir(exist_ok=True)
    for draw in (forms_by_light, farm, mixed, rims, truth):
        cv2.imwrite(str(OUT / f"{draw.__name__}.jpg"), draw(), [cv2.IMWRITE_JPEG_QUALITY, 86])
