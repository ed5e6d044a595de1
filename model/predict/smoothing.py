"""Predicted caps without notches and horns, which no cap has: smoothed by discs of a share of its size."""

from __future__ import annotations

import math

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.raster import box_of_mask

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
    area = int(np.count_nonzero(held))
    if area < FEWEST:
        return logits
    here, by = box_of_mask(held), CLOSED * _diameter(area)
    there, reach = held[here], math.ceil(by) + 1
    closed = ~_grown(~_grown(_padded(there, reach), by), by)[reach:-reach, reach:-reach]
    filled = logits.copy()
    filled[here][closed & ~there & (logits[here] > OTHERS)] = HARDLY
    return without_horns(filled, diameter=_diameter(area))


def without_horns(logits: NDArray[np.float32], *, diameter: float | None = None) -> NDArray[np.float32]:
    """(h, w) logits of a cap, negated where it is narrow beside its diameter: of its pixels, unless given."""
    held = logits > 0
    area = int(np.count_nonzero(held))
    if area < FEWEST:
        return logits
    here, by = box_of_mask(held), OPENED * (diameter or _diameter(area))
    there, reach = held[here], math.ceil(by) + 1
    opened = _grown(~_grown(~_padded(there, reach), by), by)[reach:-reach, reach:-reach]
    if np.count_nonzero(opened) < (1 - MOST_LOST) * area:
        return logits
    shorn = logits.copy()
    np.negative(shorn[here], out=shorn[here], where=there & ~opened)
    return shorn


def _padded(mask: NDArray[np.bool_], by: int) -> NDArray[np.bool_]:
    """With so many pixels of False on every side (``np.pad`` takes ten times as long)."""
    height, width = mask.shape
    padded = np.zeros((height + 2 * by, width + 2 * by), bool)
    padded[by:-by, by:-by] = mask
    return padded


def _diameter(area: int) -> float:
    return float(4 * area / np.pi) ** 0.5


def _grown(mask: NDArray[np.bool_], by: float) -> NDArray[np.bool_]:
    """A mask with all pixels that lie within so many of it."""
    away = cv2.distanceTransform((~mask).view(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    return np.asarray(away) <= by
