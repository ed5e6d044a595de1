"""From light to a photo: vignette, focus, sensor noise, white balance, tone curve."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from model.scene.layers import strips, window
from model.scene.pixels import Image, filtered, threefold
from model.scene.settings import Camera

LEVELS = 4096
SATURATION = 1.6
BLACK = 0.0022
"""Linear light a camera takes for none."""
"""Linear light at which the sensor is full."""


class Shot(NamedTuple):
    """What was drawn for one photo."""

    pitch_deg: float
    vignette: float
    balance: NDArray[np.float32]
    """(3,) gains, blue first."""
    exposure: float
    focus: float
    """Where between the soil and the highest cap the focus lies, 0–1."""
    jpeg: int


def draw_shot(camera: Camera, rng: np.random.Generator) -> Shot:
    """One photo's camera."""
    balance = np.exp(camera.tint * rng.standard_normal(3) * (1, 0.3, 1)).astype(np.float32)
    return Shot(
        pitch_deg=rng.uniform(*camera.pitch_deg),
        vignette=rng.uniform(*camera.vignette),
        balance=balance,
        exposure=camera.exposure * math.exp(0.08 * rng.standard_normal()),
        focus=rng.uniform(0.4, 0.9),
        jpeg=int(rng.integers(camera.jpeg[0], camera.jpeg[1] + 1)),
    )


def expose(
    light: Image, z: Image, *, camera: Camera, shot: Shot, dimness: float, rng: np.random.Generator
) -> NDArray[np.uint8]:
    """Linear light (rows, columns, 3) and view z (rows, columns) → an 8-bit BGR photo."""
    rows, columns = z.shape
    seen = _focused(light, z, camera=camera, shot=shot)
    grain, blots = _noise(rows, columns, rng)
    falloff = _vignette(rows, columns, shot.vignette)
    photo = np.empty((rows, columns, 3), np.uint8)
    for box in strips(rows, columns):
        here = window(box)
        fallen = filtered(seen[here] * threefold(shot.exposure * falloff[here]), shot.balance)
        # Grows with the root of the light.
        strength = np.sqrt(np.maximum(fallen[..., 1], 0) * np.float32(5e-5) + np.float32(5e-7))
        strength *= np.float32(camera.noise * dimness)
        fallen += threefold(2 * strength * grain[here]) + threefold(0.6 * strength) * blots[here]
        index = np.clip(fallen * np.float32((LEVELS - 1) / SATURATION), 0, LEVELS - 1).astype(np.uint16)
        photo[here] = np.take(_tone_curve(), index)
    return photo


def _focused(light: Image, z: Image, *, camera: Camera, shot: Shot) -> Image:
    """Sharp where the focus lies, blurred in front of and behind it."""
    sharp = cv2.GaussianBlur(light, (0, 0), camera.sharpness)
    if camera.defocus == 0:
        return sharp
    low, high = np.percentile(z[::8, ::8], (2, 99)).tolist()
    coarse = cv2.resize(z, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA)
    off = np.abs(coarse - (low + shot.focus * (high - low)))
    blur = cv2.GaussianBlur(off, (0, 0), 1.25) * np.float32(camera.defocus / 150.0)
    most = max(float(blur.max()), 1e-3)
    soft = cv2.GaussianBlur(light, (0, 0), math.hypot(camera.sharpness, most))
    # Variances add: a mixture by this share has the variance the blur asks for.
    share = cv2.resize((blur / most) ** 2, z.shape[::-1], interpolation=cv2.INTER_LINEAR)
    return cv2.blendLinear(soft, sharp, share, 1 - share)


def _vignette(rows: int, columns: int, amount: float) -> Image:
    x = np.linspace(-1, 1, columns, dtype=np.float32)[None]
    y = np.linspace(-1, 1, rows, dtype=np.float32)[:, None]
    return 1 - amount * ((x * x + y * y) / 2) ** 1.3


def _noise(rows: int, columns: int, rng: np.random.Generator) -> tuple[Image, Image]:
    """Noise in brightness (rows, columns) and in colour (rows, columns, 3), both smeared by demosaicing."""
    grain = cv2.GaussianBlur(rng.standard_normal((rows, columns), np.float32), (0, 0), 0.7)
    coarse = rng.standard_normal((rows // 2, columns // 2, 3), np.float32)
    return grain, cv2.resize(coarse, (columns, rows), interpolation=cv2.INTER_LINEAR)


@lru_cache(maxsize=1)
def _tone_curve() -> NDArray[np.uint8]:
    """sRGB with a toe and a shoulder: shadows go down to black, highlights roll off instead of clipping."""
    linear = np.maximum(np.linspace(0, SATURATION, LEVELS) - BLACK, 0)
    bright = np.where(linear < 0.6, linear, 0.6 + 0.38 * np.tanh((linear - 0.6) / 0.38))
    srgb = np.where(bright <= 0.0031308, 12.92 * bright, 1.055 * bright ** (1 / 2.4) - 0.055)
    return np.rint(255 * srgb).astype(np.uint8)
