"""From light to a photo: vignette, focus, sensor noise, white balance, tone curve."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.scene import textures
from fairyring.model.scene.focus import focused
from fairyring.model.scene.layers import strips, window
from fairyring.model.scene.pixels import Image, clipped, planes
from fairyring.model.scene.settings import Camera

LEVELS = 4096
SATURATION = 1.6
"""Linear light at which the sensor is full."""
GLARE = np.array([0.040, 0.031, 0.031], np.float32)
"""Share of the light around that strays in the lens, bluish."""
GLARE_REACH = 60.0
DEEPEST = 0.02
"""Most light that is taken for black."""


class Shot(NamedTuple):
    """What was drawn for one photo."""

    pitch_deg: float
    vignette: float
    sharpness: float
    """Standard deviation of the blur of what is in focus, px."""
    balance: NDArray[np.float32]
    """(3,) gains, blue first."""
    exposure: float
    focus: float
    """Where between the soil and the highest cap the focus lies, 0–1."""
    black: float
    """Share of the picture that the camera takes for black."""
    crisp: float
    """How much it sharpens."""
    glare: float
    jpeg: int


def draw_shot(camera: Camera, rng: np.random.Generator) -> Shot:
    """One photo's camera."""
    balance = np.exp(camera.tint * rng.standard_normal(3) * (1, 0.3, 1)).astype(np.float32)
    return Shot(
        pitch_deg=rng.uniform(*camera.pitch_deg),
        vignette=rng.uniform(*camera.vignette),
        sharpness=camera.sharpness * math.exp(0.2 * rng.standard_normal()),
        balance=balance,
        exposure=camera.exposure * math.exp(0.08 * rng.standard_normal()),
        focus=rng.uniform(*camera.focus),
        black=rng.uniform(*camera.black),
        crisp=rng.uniform(*camera.crispness),
        glare=rng.uniform(0.3, 1.7),
        jpeg=int(rng.integers(camera.jpeg[0], camera.jpeg[1] + 1)),
    )


def expose(
    light: Image, blur: Image, *, camera: Camera, shot: Shot, dimness: float, rng: np.random.Generator
) -> NDArray[np.uint8]:
    """Linear light (3, rows, columns) and its blur by depth (rows, columns) → an 8-bit BGR photo."""
    rows, columns = blur.shape
    seen = focused(light, blur, sharpness=shot.sharpness)
    seen += _stray(light) * planes(GLARE * np.float32(shot.glare))
    gain = _vignette(rows, columns, shot.vignette) * np.float32(shot.exposure)
    darkest = np.quantile(seen[:, ::8, ::8] * gain[::8, ::8], shot.black, axis=(1, 2))
    black = planes(shot.balance * np.minimum(darkest, DEEPEST))
    left, top = rng.integers(0, textures.SIZE, 2)
    grain = textures.sensor(columns)[:, :, left : left + columns]
    photo = np.empty((rows, columns, 3), np.uint8)
    for box in strips(rows, columns):
        here = window(box)
        fallen = seen[:, *here] * (planes(shot.balance) * gain[here]) - black
        # Grows with the root of the light.
        strength = np.sqrt(fallen[1].clip(0) * np.float32(5e-5) + np.float32(5e-7))
        strength *= np.float32(camera.noise * dimness)
        fallen += strength * grain[:, np.arange(top + box[1], top + box[3]) % textures.SIZE]
        fallen *= np.float32((LEVELS - 1) / SATURATION)
        index = clipped(fallen, 0, LEVELS - 1).astype(np.uint16)
        photo[here] = cv2.merge([np.take(_tone_curve(), plane) for plane in index])
    return _sharpened(photo, shot.crisp)


def _sharpened(photo: NDArray[np.uint8], amount: float) -> NDArray[np.uint8]:
    """What every camera does to its photos, more or less of it."""
    smooth = cv2.GaussianBlur(photo, (0, 0), 1.2)
    return np.asarray(cv2.addWeighted(photo, 1 + amount, smooth, -amount, 0), np.uint8)


def _stray(light: Image) -> Image:
    """Light scattered in the lens: a very wide blur."""
    shape = light.shape[:0:-1]
    factor = 2.0 / GLARE_REACH
    small = [cv2.resize(plane, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA) for plane in light]
    return np.stack([cv2.resize(cv2.GaussianBlur(plane, (0, 0), 2.0), shape) for plane in small])


def _vignette(rows: int, columns: int, amount: float) -> Image:
    x = np.linspace(-1, 1, columns // 8, dtype=np.float32)[None]
    y = np.linspace(-1, 1, rows // 8, dtype=np.float32)[:, None]
    return cv2.resize(1 - amount * ((x * x + y * y) / 2) ** 1.3, (columns, rows))


@lru_cache(maxsize=1)
def _tone_curve() -> NDArray[np.uint8]:
    """sRGB with a toe and a shoulder: shadows go down to black, highlights roll off instead of clipping."""
    linear = np.linspace(0, SATURATION, LEVELS)
    bright = np.where(linear < 0.6, linear, 0.6 + 0.38 * np.tanh((linear - 0.6) / 0.38))
    srgb = np.where(bright <= 0.0031308, 12.92 * bright, 1.055 * bright ** (1 / 2.4) - 0.055)
    return np.rint(255 * srgb).astype(np.uint8)
