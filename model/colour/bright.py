"""Bright caps on dark soil: which pixels they hold, and how wide they are."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.photo import Pixels

BLUR_PX = 1.5
LEAST_PX = 8.0
"""Least diameter that is believed where it is measured, pixels."""

Figures = NDArray[np.float32]


def grey_of(photo: Pixels) -> NDArray[np.uint8]:
    """(height, width, 3) RGB → its brightness (height, width), a little blurred."""
    grey = cv2.cvtColor(photo, cv2.COLOR_RGB2GRAY)
    return np.asarray(cv2.GaussianBlur(grey, (0, 0), BLUR_PX), np.uint8)


def bright_pixels(grey: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """(height, width), those above the threshold that parts them best from the others (Otsu, 1979)."""
    if grey.min() == grey.max():
        return np.zeros(grey.shape, bool)
    _, mask = cv2.threshold(grey, 0, 1, cv2.THRESH_BINARY + cv2.THRESH_OTSU)
    return np.asarray(mask) > 0


def depth_of(mask: NDArray[np.bool_]) -> Figures:
    """How far inside the mask each pixel lies, pixels; the photo's border is no edge."""
    around = np.pad(mask, 1, mode="edge").astype(np.uint8)
    return np.asarray(cv2.distanceTransform(around, cv2.DIST_L2, 5), np.float32)[1:-1, 1:-1]


def peaks_of(values: Figures, *, within: float) -> NDArray[np.int64]:
    """(n, 2) row, column of the pixels above 0 that none within so many pixels exceeds; one of a plateau."""
    side = 2 * max(1, round(within)) + 1
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side))
    highest = (values > 0) & (values >= np.asarray(cv2.dilate(values, disc)))
    middles = cv2.connectedComponentsWithStats(highest.astype(np.uint8), connectivity=8)[3]
    return np.asarray(middles[1:, ::-1], np.int64)


def usual_diameter(depth: Figures) -> float | None:
    """Twice the median depth of the peaks, of those at least half as deep as a deep one; None of nothing."""
    peaks = peaks_of(depth, within=LEAST_PX / 2)
    deep = depth[peaks[:, 0], peaks[:, 1]]
    deep = deep[2 * deep >= LEAST_PX]
    if not len(deep):
        return None
    deep = deep[deep >= np.quantile(deep, 0.9) / 2]
    return float(2 * np.median(deep))


def flooded(depth: Figures, peaks: NDArray[np.int64]) -> NDArray[np.int64]:
    """(height, width) the number from 1 of the peak whose hill each pixel is on; 0 where ``depth`` is 0.

    Watershed by flooding (Vincent and Soille, 1991), the depth upside down: pixel by pixel, from the deepest
    level on, each goes to the hill that it touches. ``peaks`` (n, 2): row, column.
    """
    hills = np.zeros(depth.shape, np.float32)
    hills[peaks[:, 0], peaks[:, 1]] = np.arange(1, len(peaks) + 1)
    neighbours = np.ones((3, 3), np.uint8)
    for level in np.arange(np.ceil(float(depth.max(initial=0))), -1, -1):
        within = depth > level
        while True:
            grown = np.where((hills == 0) & within, np.asarray(cv2.dilate(hills, neighbours)), hills)
            if (grown == hills).all():
                break
            hills = grown
    return hills.astype(np.int64)
