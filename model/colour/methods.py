"""The methods by name, and what each finds in a photo: circles by Hough, watershed by distance, corners.

They are those that the paper's Table 1 compares with, as far as they need brightness alone. On dense beds
none comes near a network; they serve people who have no weights, and as a scale for those who have.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple, get_args

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.colour.bright import bright_pixels, depth_of, flooded, grey_of, peaks_of, usual_diameter
from fairyring.model.geometry.clipping import clipped_outline
from fairyring.model.geometry.mask_tracing import outline_of_mask
from fairyring.model.geometry.shapes import Circle, Outline, part_of_points, points_of_part, polygon_of_shape
from fairyring.model.photo import Pixels

Method = Literal["hough", "watershed", "corners"]
METHODS: tuple[Method, ...] = get_args(Method)

SMALLEST, LARGEST = 0.5, 1.8
"""Diameters that are looked for, as multiples of the usual one."""
CANNY, VOTES = 80.0, 14.0
"""Hough's thresholds: gradient of an edge, and votes for a circle (Yuen et al., 1990)."""
APART = 0.5
"""Least distance of two caps' middles, in usual diameters."""
CORNER_QUALITY = 0.02
"""Corners count from this share of the strongest one's strength (Shi and Tomasi, 1994)."""


class Found(NamedTuple):
    """A cap, and how much speaks for it, 0 to 1: no probability."""

    score: float
    outline: Outline


def find_caps(photo: Pixels, method: Method, *, diameter: float | None = None) -> list[Found]:
    """The caps of a photo (height, width, 3) uint8 RGB, in falling order of score.

    ``diameter``: how wide most caps are, pixels; measured on the bright areas where it is not given.
    """
    grey = grey_of(photo)
    bright = bright_pixels(grey)
    wide = diameter or usual_diameter(depth_of(bright))
    found = _BY_NAME[method](grey, bright, wide) if wide else []
    return sorted(found, key=lambda one: -one.score)


def _hough(grey: NDArray[np.uint8], bright: NDArray[np.bool_], wide: float) -> list[Found]:
    """Circles that many edge pixels vote for; the score is the bright share of the circle's pixels."""
    circles = cv2.HoughCircles(
        grey,
        cv2.HOUGH_GRADIENT,
        dp=1,
        minDist=APART * wide,
        param1=CANNY,
        param2=VOTES,
        minRadius=round(SMALLEST * wide / 2),
        maxRadius=round(LARGEST * wide / 2),
    )
    found = [] if circles is None else np.reshape(circles, (-1, circles.shape[-1]))[:, :3].tolist()
    return _as_discs([(x + 0.5, y + 0.5, r) for x, y, r in found], bright)


def _watershed(grey: NDArray[np.uint8], bright: NDArray[np.bool_], wide: float) -> list[Found]:
    """Bright areas parted where they are narrow; the score is how much of its enclosing circle each fills."""
    del grey
    depth = depth_of(bright)
    peaks = peaks_of(np.where(depth >= SMALLEST * wide / 4, depth, 0), within=APART * wide / 2)
    parts = flooded(depth, peaks)
    found = []
    for nth in range(1, len(peaks) + 1):
        mask = (parts == nth).astype(np.uint8)
        x, y, width, height = cv2.boundingRect(mask)
        corner = np.array([x, y])
        cut = np.ascontiguousarray(mask[y : y + height, x : x + width])
        outline = [part_of_points(points_of_part(part) + corner) for part in outline_of_mask(cut)]
        if outline:
            _, radius = cv2.minEnclosingCircle(np.argwhere(cut).astype(np.float32))
            found.append(Found(min(1.0, float(cut.sum()) / (np.pi * (radius + 0.5) ** 2)), outline))
    return found


def _corners(grey: NDArray[np.uint8], bright: NDArray[np.bool_], wide: float) -> list[Found]:
    """Discs about the places that corners are sparsest around: caps are smooth, and meet in corners."""
    del grey
    edge = cv2.GaussianBlur(bright.astype(np.float32), (0, 0), 1.0)
    corners = cv2.goodFeaturesToTrack(edge, maxCorners=5000, qualityLevel=CORNER_QUALITY, minDistance=3)
    away = np.ones(bright.shape, np.uint8)
    if corners is not None:
        columns, rows = np.reshape(corners, (-1, 2)).astype(int).T
        away[rows, columns] = 0
    free = np.asarray(cv2.distanceTransform(away, cv2.DIST_L2, 5), np.float32)
    room = np.minimum(free, depth_of(bright))
    room = np.minimum(room, LARGEST * wide / 2)
    peaks = peaks_of(np.where(room >= SMALLEST * wide / 2, room, 0), within=APART * wide)
    return _as_discs([(x + 0.5, y + 0.5, float(room[y, x])) for y, x in peaks.tolist()], bright)


def _as_discs(circles: list[tuple[float, float, float]], bright: NDArray[np.bool_]) -> list[Found]:
    """The circles that are bright for the most part, each with that share as its score."""
    height, width = bright.shape
    rows, columns = np.ogrid[:height, :width]
    found = []
    for x, y, r in circles:
        top, bottom = max(0, int(y - r)), min(height, int(y + r) + 1)
        left, right = max(0, int(x - r)), min(width, int(x + r) + 1)
        disc = np.hypot(rows[top:bottom] + 0.5 - y, columns[:, left:right] + 0.5 - x) <= r
        share = float(bright[top:bottom, left:right][disc].mean()) if disc.any() else 0.0
        if share >= 0.5:
            outline = clipped_outline([polygon_of_shape(Circle(x, y, r))], width=width, height=height)
            found.append(Found(share, outline))
    return found


_BY_NAME: dict[Method, Callable[[NDArray[np.uint8], NDArray[np.bool_], float], list[Found]]] = {
    "hough": _hough,
    "watershed": _watershed,
    "corners": _corners,
}
