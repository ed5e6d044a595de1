"""Predicted caps without notches and horns, which no cap has: smoothed by discs of a share of its size."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

CLOSED, OPENED = 0.2, 0.1
"""Radii of the discs that no notch, and no horn, is too narrow for, as shares of the cap's diameter."""
OTHERS = -3.0
"""A logit this far below 0 is another cap's pixel, or surely none of this one."""
HARDLY = 0.5
"""The logit of a pixel of a notch once it is filled."""
FEWEST = 30
"""Caps of fewer pixels are left as they are."""
MOST_LOST = 0.25
"""What would lose more of its pixels is no cap with a horn, but narrow."""


def smoothed(logits: NDArray[np.float32]) -> NDArray[np.float32]:
    """(h, w) logits of a cap: narrow notches are filled, unless another lies there; horns are taken off."""
    held = logits > 0
    area = np.count_nonzero(held)
    if area < FEWEST:
        return logits
    diameter = (4 * area / np.pi) ** 0.5
    closed = _morphed(held, cv2.MORPH_CLOSE, radius=CLOSED * diameter)
    filled = np.where(closed & ~held & (logits > OTHERS), np.float32(HARDLY), logits)
    opened = _morphed(filled > 0, cv2.MORPH_OPEN, radius=OPENED * diameter)
    if np.count_nonzero(opened) < (1 - MOST_LOST) * area:
        return filled
    return np.where((filled > 0) & ~opened, -filled, filled)


def _morphed(mask: NDArray[np.bool_], way: int, *, radius: float) -> NDArray[np.bool_]:
    reach = int(np.ceil(radius))
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    disc = (np.hypot(x, y) <= radius).astype(np.uint8)
    padded = np.pad(mask, reach).astype(np.uint8)
    done = cv2.morphologyEx(padded, way, disc)
    return done[reach : padded.shape[0] - reach, reach : padded.shape[1] - reach] > 0
