"""Visible rims of many caps as one array, so that an image is fitted at once.

Legend: n caps, K = `BINS` points each, evenly along the contour. A point is the mean of its stretch of
contour pixels, moved out to where the edge is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.contour.silhouette import Silhouette, contours_of
from fairyring.model.geometry.shapes import Points
from fairyring.model.geometry.told_arcs import NOT_TOLD, told_of_points

BINS = 48
LEAST_PART = 0.1
"""A part with a shorter contour than this share of the longest is a crumb, and is left out."""

_LAST, _NEXT = np.arange(BINS) - 1, np.arange(1, BINS + 1) % BINS


@dataclass(frozen=True, slots=True)
class Rims:
    """The visible outlines of n caps."""

    points: NDArray[np.float64]
    """(n, K, 2)"""
    outward: NDArray[np.float64]
    """(n, K, 2), unit normals."""
    spacing: NDArray[np.float64]
    """(n, K), the length of outline that each point stands for, pixels."""
    pixels: NDArray[np.int_]
    """(n,), how many contour pixels there were."""
    area: NDArray[np.float64]
    """(n,), inside the points, px²."""
    corner: NDArray[np.bool_]
    """(n, K), whether the points' convex hull has a corner here."""
    told: NDArray[np.int64]
    """(n, K), what people said of the points, as `told_of_points` has it."""


def rims_of(caps: Sequence[Silhouette]) -> Rims:
    """The rims of n ≥ 1 silhouettes, each with something to see. Parts follow each other along the rim."""
    contours = [_whole_contour(cap) for cap in caps]
    pixels = np.array([len(contour) - 1 for contour in contours])
    points = _even_means(np.concatenate(contours), pixels)
    along = points.take(_NEXT, axis=1) - points.take(_LAST, axis=1)
    length = np.hypot(along[..., 0], along[..., 1])
    outward = np.stack([along[..., 1], -along[..., 0]], axis=-1) / np.maximum(length, 1e-9)[..., None]
    outward *= np.where(_area(points) >= 0, 1, -1)[:, None, None]
    # The outermost pixel centres lie half a pixel's width inside the edge, measured along its normal.
    points = points + outward * (np.abs(outward).max(axis=-1, keepdims=True) / 2)
    spacing = length / 2
    return Rims(
        points,
        outward,
        spacing,
        pixels,
        np.abs(_area(points)),
        _corners(points),
        _told(caps, points, spacing),
    )


def _told(
    caps: Sequence[Silhouette], points: NDArray[np.float64], spacing: NDArray[np.float64]
) -> NDArray[np.int64]:
    """(n, K), what people said of the points (n, K, 2) of these rims."""
    told = np.full(points.shape[:2], NOT_TOLD)
    for nth, cap in enumerate(caps):
        if cap.told:
            told[nth] = told_of_points(cap.told, points[nth], spacing[nth])
    return told


def _corners(points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(n, K), where the convex hulls of closed polygons (n, K, 2) have their corners."""
    corner = np.zeros(points.shape[:2], np.bool_)
    for own, rim in zip(corner, (points - points[:, :1]).astype(np.float32, order="C"), strict=True):
        own[cv2.convexHull(rim, returnPoints=False)] = True
    return corner


def _whole_contour(cap: Silhouette) -> Points:
    """Of all parts, from the farthest point round to it again: turned masks shall give turned points."""
    contour = np.concatenate(contours_of(cap, least=LEAST_PART))
    away = contour - contour.sum(axis=0) / len(contour)
    start = int(np.einsum("ij,ij->i", away, away).argmax())
    return np.concatenate([contour[start:], contour[: start + 1]])


def _area(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,), shoelace areas of closed polygons (n, K, 2), positive where they run clockwise on the screen."""
    away = points - points[:, :1]
    beside = away.take(_NEXT, axis=1)
    return (away[..., 0] * beside[..., 1] - away[..., 1] * beside[..., 0]).sum(axis=1) / 2


def _even_means(contours: Points, pixels: NDArray[np.int_]) -> NDArray[np.float64]:
    """(n, K, 2): the means of K even stretches of each of n contours that follow one another in one array.

    Each ends where it starts, half of that point for the first stretch and half for the last. The means of a
    contour are the same to the last digit whatever the others are.
    """
    total = np.concatenate([np.zeros((1, 2)), np.cumsum(contours, axis=0)])
    first = np.concatenate([[0], np.cumsum(pixels + 1)[:-1]])[:, None]
    along = 0.5 + pixels[:, None] * (np.arange(BINS + 1) / BINS)
    whole = along.astype(np.int64)
    # Sums of pixel centres are exact, and so are their differences.
    since = total[first + whole] - total[first]
    until = since + (along - whole)[..., None] * contours[first + whole]
    return np.diff(until, axis=1) * (BINS / pixels[:, None, None])
