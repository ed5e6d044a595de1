"""Non-maximum suppression of masks, and overlap resolution: which of two caps a pixel belongs to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.raster import box_of_mask
from fairyring.model.predict.smoothing import without_horns

CONFIDENT = 0.3
"""Least score of an instance that takes pixels from others."""
MOST_TAKEN = 0.5
"""An instance with more than this share of its pixels in better ones is a duplicate."""

LEAST_PART = 0.5
"""Parts under this share of the largest are left out: a cap parted by what lies over it is rare."""


@dataclass(frozen=True, kw_only=True)
class Window:
    """One instance's logits at photo pixels, (h, w) float32; its first pixel is column x, row y."""

    x: int
    y: int
    logits: NDArray[np.float32]


def distinct(masks: NDArray[np.bool_], scores: Sequence[float]) -> list[int]:
    """Indices of the instances that do not lie, for the most part, on better and confident ones.

    ``masks`` (n, h, w), of any stride; ``scores`` must fall. An empty mask is left out, too.
    """
    taken = np.zeros(masks.shape[1:], bool)
    kept = []
    for nth, (mask, score) in enumerate(zip(masks, scores, strict=True)):
        area = np.count_nonzero(mask)
        if area == 0 or np.count_nonzero(mask & taken) > MOST_TAKEN * area:
            continue
        kept.append(nth)
        if score >= CONFIDENT:
            taken |= mask
    return kept


def resolve_overlaps(
    windows: Sequence[Window], scores: Sequence[float], *, width: int, height: int
) -> list[Window]:
    """The windows cut to the photo, each logit lowered by the largest that another, confident one has there.

    Where two caps touch, the edge then runs where they are equally sure. Components under half of the
    largest are left out, and so are horns, before they take pixels: a tongue would be left in another cap.
    What others leave of a cap beside its largest part goes, too: people take such a scrap for another cap.
    """
    inside = [without_specks(cut(window, width=width, height=height)) for window in windows]
    inside = [replace(window, logits=without_horns(window.logits)) for window in inside]
    first, second = np.zeros((2, height, width), np.float32)
    owner = np.full((height, width), -1, np.int32)
    for nth, (window, score) in enumerate(zip(inside, scores, strict=True)):
        if score >= CONFIDENT:
            _claim(window, nth, first, second, owner)
    resolved = []
    for nth, window in enumerate(inside):
        here = _slices_of(window)
        others = np.where(owner[here] == nth, second[here], first[here])
        resolved.append(without_specks(replace(window, logits=window.logits - others)))
    return resolved


def without_specks(window: Window) -> Window:
    """The same with negated logits in parts that are too small beside the largest."""
    held = window.logits > 0
    if not held.any():
        return window
    here = box_of_mask(held)
    count, parts, figures, _ = cv2.connectedComponentsWithStats(held[here].astype(np.uint8), connectivity=4)
    areas = figures[1:, cv2.CC_STAT_AREA]
    specks = np.flatnonzero(areas < LEAST_PART * areas.max()) + 1
    if count == 2 or not len(specks):
        return window
    turned = window.logits.copy()
    np.negative(turned[here], out=turned[here], where=np.isin(parts, specks))
    return replace(window, logits=turned)


def _claim(
    window: Window,
    nth: int,
    first: NDArray[np.float32],
    second: NDArray[np.float32],
    owner: NDArray[np.int32],
) -> None:
    """Enters an instance's logits among the largest and second largest of each pixel, none below 0."""
    here = _slices_of(window)
    best, next_best = first[here], second[here]
    wins = window.logits > best
    np.copyto(next_best, np.maximum(next_best, np.where(wins, best, window.logits)))
    np.copyto(best, window.logits, where=wins)
    owner[here][wins] = nth


def _slices_of(window: Window) -> tuple[slice, slice]:
    height, width = window.logits.shape
    return slice(window.y, window.y + height), slice(window.x, window.x + width)


def cut(window: Window, *, width: int, height: int) -> Window:
    """What of a window lies in a photo of this size."""
    left, top = min(max(0, -window.x), window.logits.shape[1]), min(max(0, -window.y), window.logits.shape[0])
    right, bottom = max(left, width - window.x), max(top, height - window.y)
    return Window(
        x=min(max(0, window.x), width),
        y=min(max(0, window.y), height),
        logits=window.logits[top:bottom, left:right],
    )
