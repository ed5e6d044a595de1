"""Refining masks to photo pixels: logits are doubled again and again, and computed anew where unclear.

PointRend's inference (Kirillov et al., CVPR 2020), on each instance's own window and never on whole images.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor
from torch.nn import functional as F

from fairyring.model.network.boxes import main_boxes_of, with_margin
from fairyring.model.network.decode import Instances
from fairyring.model.network.point_rend import PointHead, PointMaps, Queries

POINTS_PER_SIDE = 8
"""Points computed anew in each doubling, for each pixel of the window's side."""
LEAST_SCORE = 0.3
"""Instances of a lower score are only enlarged: hardly any is a cap, and there are many."""
ROOM = 1
"""Cells around a mask and its margin, on every side, into which it may grow when it is refined."""
WINDOWS = (4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512)
"""Sides of windows in cells of the mask; instances of one side are refined together."""


class RefinedMask(NamedTuple):
    """One instance at photo pixels."""

    x: int
    y: int
    """Column x and row y of the window's first pixel; the window may reach beyond the photo."""
    logits: Tensor
    """(s, s); above 0 is cap."""


def refine(
    head: PointHead | None,
    maps: PointMaps | None,
    instances: Instances,
    *,
    image: int,
    mask_stride: int,
    finest: int = 1,
) -> list[RefinedMask]:
    """Refines every instance to photo pixels.

    ``finest``: photo pixels a side of the finest points seen anew. From there on, and without a point head,
    logits are enlarged bilinearly, and so are those of instances whose score is below LEAST_SCORE.
    """
    refined: list[RefinedMask | None] = [None] * len(instances.scores)
    boxes = main_boxes_of(instances.logits > 0)
    windows = with_margin(boxes, least=1)
    corners, sides = windows[:, :2], windows[:, 2:].amax(1) + 2 * ROOM
    sure = instances.scores >= LEAST_SCORE
    for low, high in zip((0, *WINDOWS), WINDOWS, strict=False):
        for seen_anew in (True, False):
            group = ((sides > low) & (sides <= high) & (sure == seen_anew)).nonzero().squeeze(1)
            if not len(group):
                continue
            # In the middle of its window, the mask may grow on all sides alike.
            first = corners[group] - (high - windows[group, 2:]).div(2, rounding_mode="floor")
            at = first * mask_stride
            logits = _windows(instances.logits[group], first.long(), side=high)
            asker = None
            if seen_anew and head is not None and maps is not None:
                kernels, frames = instances.kernels[group], boxes[group] * mask_stride
                asker = _Asker(head, maps, kernels, frames, at, image)
            logits = _enlarged(logits, asker, stride=mask_stride, finest=finest)
            for index, (x, y), window in zip(group.tolist(), at.long().tolist(), logits, strict=True):
                refined[index] = RefinedMask(x, y, window)
    return [one for one in refined if one is not None]


class _Asker(NamedTuple):
    """What the point head is told about n instances of one image."""

    head: PointHead
    maps: PointMaps
    kernels: Tensor
    """(n, E)."""
    boxes: Tensor
    """(n, 4), photo pixels."""
    corners: Tensor
    """(n, 2): of their windows, photo pixels."""
    image: int


def _enlarged(logits: Tensor, asker: _Asker | None, *, stride: int, finest: int) -> Tensor:
    """Windows (n, s, s) of cells of ``stride`` photo pixels → (n, s · stride, s · stride) photo pixels."""
    while stride > 1:
        stride //= 2
        logits = F.interpolate(logits[:, None], scale_factor=2.0, mode="bilinear")[:, 0]
        if asker is not None and stride >= finest:
            _see_anew(logits, asker, stride=stride)
    return logits


def _see_anew(logits: Tensor, asker: _Asker, *, stride: int) -> None:
    """Puts the head's logits into ``logits`` (n, s, s) where these are nearest 0."""
    count, side = logits.shape[:2]
    flat = logits.view(count, -1)
    chosen = flat.abs().topk(min(POINTS_PER_SIDE * side, flat.shape[1]), dim=1, largest=False).indices
    where = torch.stack([chosen % side, chosen // side], dim=2)
    each = torch.arange(count, device=logits.device).repeat_interleave(chosen.shape[1])
    queries = Queries(
        points=(asker.corners[:, None] + (where.float() + 0.5) * stride).reshape(-1, 2),
        owners=torch.full_like(each, asker.image),
        kernels=asker.kernels[each],
        boxes=asker.boxes[each],
        coarse=flat.gather(1, chosen).flatten(),
    )
    flat.scatter_(1, chosen, asker.head(asker.maps, queries).reshape(chosen.shape))


def _windows(logits: Tensor, corners: Tensor, *, side: int) -> Tensor:
    """(n, h, w), (n, 2) → (n, side, side); beyond the map its outermost values hold on."""
    reach = torch.arange(side, device=logits.device)
    x = (corners[:, :1] + reach).clamp(0, logits.shape[2] - 1)
    y = (corners[:, 1:] + reach).clamp(0, logits.shape[1] - 1)
    each = torch.arange(len(logits), device=logits.device)[:, None, None]
    return logits[each, y[:, :, None], x[:, None, :]]
