"""Arithmetic on pictures: grey (rows, columns) with colour and vectors (3, rows, columns).

The planes lie apart, so that a grey picture meets each of them whole: NumPy stretches a last axis of three
element by element, and OpenCV takes longer to split channels than to work on them.
"""

from __future__ import annotations

import math
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

Image = NDArray[Any]
"""float32 throughout; OpenCV's stubs do not say so."""
Colour = NDArray[np.floating]
"""(3,), blue first."""


def tinted(grey: Image, colour: Colour) -> Image:
    """A grey picture in a colour."""
    return grey * planes(colour)


def planes(colour: Colour) -> Image:
    """One colour as a picture of one pixel, which stretches to any size."""
    return np.asarray(colour, np.float32)[:, None, None]


def mixed(under: Image, over: Image, share: Image) -> Image:
    """``over`` laid over ``under`` by ``share`` (rows, columns)."""
    return under + (over - under) * share


def lay_over(under: Image, over: Image, share: Image) -> None:
    """The same where ``under`` lies."""
    under += (over - under) * share


def clipped(values: Image, low: float, high: float) -> Image:
    """Within limits, in place: several times as fast as a maximum and a minimum."""
    return values.clip(low, high, out=values)


def step(start: float | Image, end: float | Image, values: Image) -> Image:
    """0 before ``start``, 1 after ``end``, smooth between; ``end`` may be the lesser."""
    t = clipped((values - start) / (end - start), 0, 1)
    return t * t * (3 - 2 * t)


def blurred(image: Image, reach: float) -> Image:
    """A Gaussian blur, by way of half the size where nothing that fine is left."""
    if reach < 1.6:
        return cv2.GaussianBlur(image, (0, 0), reach)
    half = cv2.resize(image, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
    # There and back blurs too: by a variance of 3/4.
    rest = math.sqrt(reach**2 - 0.75) / 2
    return cv2.resize(cv2.GaussianBlur(half, (0, 0), rest), image.shape[::-1])


def widely_blurred(image: Image, reach: float, size: tuple[int, int]) -> Image:
    """A Gaussian blur of ``reach`` px by way of a smaller picture, at (columns, rows) of its own."""
    factor = min(2.0 / reach, 1.0)
    small = cv2.resize(image, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA)
    return cv2.resize(cv2.GaussianBlur(small, (0, 0), reach * factor), size, interpolation=cv2.INTER_LINEAR)
