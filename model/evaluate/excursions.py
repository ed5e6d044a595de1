"""How far a predicted outline strays from the true one at its worst: horns, tails, notches and arcs too wide.

A mean such as the IoU hardly sees them, and each takes a person a drag to mend.
"""

from __future__ import annotations

import math

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.raster import Mask, Rle
from fairyring.model.geometry.rle import checked_counts, cut_of_counts

LEAST_PX, SHARE_OF_DIAMETER = 2.0, 0.06
"""A worst deviation of at most this many pixels, or this share of the diameter, is no excursion."""
RIM = np.ones((3, 3), np.uint8)


def strays(predicted: Rle, true: Rle) -> bool:
    """Whether the rim of a predicted mask has an excursion: see ``LEAST_PX``; the diameter is of the circle
    with the true visible area."""
    masks = _in_one_window(predicted, true)
    diameter = 2 * math.sqrt(np.count_nonzero(masks[1]) / math.pi)
    return _worst(*masks) > max(LEAST_PX, SHARE_OF_DIAMETER * diameter)


def worst_deviation(predicted: Rle, true: Rle) -> float:
    """The largest distance of a rim pixel of either mask from the other's rim, pixels (Hausdorff's distance).

    Neither mask may be empty, and both must be of one size. Raises GeometryError.
    """
    return _worst(*_in_one_window(predicted, true))


def _worst(predicted: Mask, true: Mask) -> float:
    first, second = _rim(predicted), _rim(true)
    return max(float(_away_from(second)[first].max()), float(_away_from(first)[second].max()))


def _rim(mask: Mask) -> NDArray[np.bool_]:
    """The pixels of a mask beside others that are not of it; the outside is none of it."""
    inner = cv2.erode(mask, RIM, borderType=cv2.BORDER_CONSTANT, borderValue=(0,))
    return (mask > 0) & (np.asarray(inner) == 0)


def _away_from(rim: NDArray[np.bool_]) -> NDArray[np.float32]:
    away = cv2.distanceTransform((~rim).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    return np.asarray(away, np.float32)


def _in_one_window(*codes: Rle) -> list[Mask]:
    """The masks of both, cut to the box around them."""
    cuts = [cut_of_counts(height, counts) for height, _, counts in map(checked_counts, codes)]
    left, top = (min(corner[axis] for _, corner in cuts) for axis in (0, 1))
    right = max(corner[0] + mask.shape[1] for mask, corner in cuts)
    bottom = max(corner[1] + mask.shape[0] for mask, corner in cuts)
    masks = []
    for mask, (x, y) in cuts:
        window = np.zeros((bottom - top, right - left), np.uint8)
        window[y - top : y - top + mask.shape[0], x - left : x - left + mask.shape[1]] = mask
        masks.append(window)
    return masks
