"""Boxes as left, top, right, bottom in photo pixels: overlap, coding against anchors, suppression."""

from __future__ import annotations

import math

import torch
from torch import Tensor

MOST_GROWTH = math.log(1000 / 16)
"""Largest logarithm of the factor by which a box may grow beside its anchor (Faster R-CNN's own bound)."""


def corners_of(boxes: Tensor) -> Tensor:
    """(n, 4) x, y, width, height → left, top, right, bottom."""
    return torch.cat([boxes[:, :2], boxes[:, :2] + boxes[:, 2:]], dim=1)


def areas_of(boxes: Tensor) -> Tensor:
    """(n, 4) → (n,) areas, pixels²."""
    return (boxes[:, 2:] - boxes[:, :2]).clamp(min=0).prod(1)


def overlaps_of(first: Tensor, second: Tensor) -> Tensor:
    """Intersection over union of every box (n, 4) with every other (m, 4) → (n, m); 0 of empty ones."""
    left_top = torch.maximum(first[:, None, :2], second[None, :, :2])
    right_bottom = torch.minimum(first[:, None, 2:], second[None, :, 2:])
    shared = (right_bottom - left_top).clamp(min=0).prod(2)
    union = areas_of(first)[:, None] + areas_of(second)[None] - shared
    return shared / union.clamp(min=1e-9)


def coded(boxes: Tensor, anchors: Tensor, *, weights: tuple[float, float]) -> Tensor:
    """Boxes (n, 4) as shifts and growths of their anchors (n, 4), as Faster R-CNN learns them.

    Ren et al., NeurIPS 2015, Eq. 2. ``weights``: factors on the shifts and on the growths.
    """
    middles, sizes = _middles_and_sizes(boxes)
    at, extent = _middles_and_sizes(anchors)
    shift, growth = (middles - at) / extent, (sizes / extent).log()
    return torch.cat([shift * weights[0], growth * weights[1]], dim=1)


def decoded(codes: Tensor, anchors: Tensor, *, weights: tuple[float, float]) -> Tensor:
    """The boxes that ``coded`` made these codes of."""
    at, extent = _middles_and_sizes(anchors)
    middles = at + codes[:, :2] / weights[0] * extent
    half = extent * (codes[:, 2:] / weights[1]).clamp(max=MOST_GROWTH).exp() / 2
    return torch.cat([middles - half, middles + half], dim=1)


def within(boxes: Tensor, *, width: float, height: float) -> Tensor:
    """The boxes cut to a photo of this size."""
    most = boxes.new_tensor([width, height, width, height])
    return torch.minimum(boxes.clamp(min=0), most)


def suppressed(boxes: Tensor, scores: Tensor, *, most_overlap: float, most: int) -> Tensor:
    """Non-maximum suppression → indices of the at most ``most`` boxes that stay, best first.

    A box goes where it overlaps a better one that stays by more than ``most_overlap``.
    """
    order = scores.argsort(descending=True, stable=True)
    covers = overlaps_of(boxes[order], boxes[order]) > most_overlap
    gone = torch.zeros(len(order), dtype=torch.bool, device=boxes.device)
    stay: list[int] = []
    for nth in range(len(order)):
        if gone[nth]:
            continue
        stay.append(nth)
        if len(stay) == most:
            break
        gone |= covers[nth]
    return order[torch.tensor(stay, dtype=torch.int64, device=order.device)]


def quickly_suppressed(boxes: Tensor, scores: Tensor, *, most_overlap: float, most: int) -> Tensor:
    """YOLACT's fast suppression: a box goes where any better one overlaps it, whether that stays or not.

    Bolya et al., ICCV 2019, section 3.3 → indices of those that stay, best first.
    """
    order = scores.argsort(descending=True, stable=True)[:most]
    covers = overlaps_of(boxes[order], boxes[order]).triu(diagonal=1)
    return order[covers.amax(0) <= most_overlap] if len(order) else order


def _middles_and_sizes(boxes: Tensor) -> tuple[Tensor, Tensor]:
    sizes = (boxes[:, 2:] - boxes[:, :2]).clamp(min=1e-3)
    return boxes[:, :2] + sizes / 2, sizes
