"""Arithmetic on pictures: grey (rows, columns) with colour (rows, columns, 3).

NumPy stretches a last axis of three element by element; joining whole channels is ten times faster.
"""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

Image = NDArray[Any]
"""float32 throughout; OpenCV's stubs do not say so."""
Colour = NDArray[np.floating]
"""(3,), blue first."""


def threefold(grey: Image) -> Image:
    """The same in every channel."""
    return cv2.merge([grey, grey, grey])


def tinted(grey: Image, colour: Colour) -> Image:
    """A grey picture in a colour."""
    return cv2.merge([grey * np.float32(part) for part in colour])


def filtered(image: Image, colour: Colour) -> Image:
    """A coloured picture through a filter of a colour."""
    return cv2.transform(image, np.diag(colour).astype(np.float32))


def mixed(under: Image, over: Image | Colour, share: Image) -> Image:
    """``over``, a picture or one colour, laid over ``under`` by ``share`` (rows, columns)."""
    share = np.asarray(share, np.float32)
    if over.ndim > 1:
        return under + (over - under) * threefold(share)
    return under * threefold(1 - share) + tinted(share, over)


def unit(vectors: Image) -> Image:
    """Vectors (rows, columns, 3) at length 1."""
    x, y, z = cv2.split(vectors)
    return vectors * threefold(1 / np.sqrt(x * x + y * y + z * z))
