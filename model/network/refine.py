"""Drawing the edge at photo pixels: each instance's logits, doubled again and again, seen anew where unclear.

PointRend's inference (Kirillov et al., CVPR 2020), on each instance's own window and never on whole images.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor
from torch.nn import functional as F  # noqa: N812

from model.network.decode import Instances
from model.network.point_rend import PointHead, PointMaps

MARGIN = 0.1
"""Of the window around a mask's box, on every side."""
POINTS_PER_SIDE = 8
"""Points seen anew in each doubling, for each pixel of the window's side: 784 at 98 pixels, 2048 at 256."""
WINDOWS = (4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512)
"""Sides of windows in cells of the mask; instances of one side are drawn together."""


class Drawn(NamedTuple):
    """One instance at photo pixels."""

    x: int
    y: int
    """Of the window's first pixel; the window may reach beyond the photo."""
    logits: Tensor
    """(s, s); above 0 is cap."""


def draw(
    head: PointHead | None, maps: PointMaps | None, instances: Instances, *, image: int, mask_stride: int
) -> list[Drawn]:
    """Every instance at photo pixels. Without a point head its logits are enlarged bilinearly."""
    drawn: list[Drawn | None] = [None] * len(instances.scores)
    boxes = boxes_of(instances.logits > 0)
    margin = (boxes[:, 2:] * MARGIN).ceil().clamp(min=1)
    corners, sides = boxes[:, :2] - margin, (boxes[:, 2:] + 2 * margin).amax(1)
    for low, high in zip((0, *WINDOWS), WINDOWS, strict=False):
        of_side = ((sides > low) & (sides <= high)).nonzero().squeeze(1)
        if not len(of_side):
            continue
        logits = _windows(instances.logits[of_side], corners[of_side].long(), side=high)
        at = corners[of_side] * mask_stride
        stride = mask_stride
        while stride > 1:
            logits, stride = (
                F.interpolate(logits[:, None], scale_factor=2.0, mode="bilinear")[:, 0],
                stride // 2,
            )
            if head is not None and maps is not None:
                kernels, frames = instances.kernels[of_side], boxes[of_side] * mask_stride
                _see_anew(head, maps, logits, kernels, frames, at, image=image, stride=stride)
        for index, (x, y), window in zip(of_side.tolist(), at.long().tolist(), logits, strict=True):
            drawn[index] = Drawn(x, y, window)
    return [one for one in drawn if one is not None]


def boxes_of(masks: Tensor) -> Tensor:
    """(K, h, w) bool, none empty → (K, 4) float x, y, width, height of each mask."""
    columns, rows = masks.any(1).float(), masks.any(2).float()
    left, top = columns.argmax(1), rows.argmax(1)
    right, bottom = masks.shape[2] - columns.flip(1).argmax(1), masks.shape[1] - rows.flip(1).argmax(1)
    return torch.stack([left, top, right - left, bottom - top], dim=1).float()


def _windows(logits: Tensor, corners: Tensor, *, side: int) -> Tensor:
    """(n, h, w), (n, 2) → (n, side, side); beyond the map its outermost values hold on."""
    reach = torch.arange(side, device=logits.device)
    x = (corners[:, :1] + reach).clamp(0, logits.shape[2] - 1)
    y = (corners[:, 1:] + reach).clamp(0, logits.shape[1] - 1)
    each = torch.arange(len(logits), device=logits.device)[:, None, None]
    return logits[each, y[:, :, None], x[:, None, :]]


def _see_anew(
    head: PointHead,
    maps: PointMaps,
    logits: Tensor,
    kernels: Tensor,
    boxes: Tensor,
    at: Tensor,
    *,
    image: int,
    stride: int,
) -> None:
    """Puts the head's logits into ``logits`` (n, s, s) where these are nearest 0."""
    count, side = logits.shape[:2]
    flat = logits.view(count, -1)
    chosen = flat.abs().topk(min(POINTS_PER_SIDE * side, flat.shape[1]), dim=1, largest=False).indices
    where = torch.stack([chosen % side, chosen // side], dim=2)
    points = (at[:, None] + (where.float() + 0.5) * stride).reshape(-1, 2)
    each = torch.arange(count, device=logits.device).repeat_interleave(chosen.shape[1])
    owners = torch.full_like(each, image)
    said = head(maps, kernels[each], owners, boxes[each], flat.gather(1, chosen).flatten(), points)
    flat.scatter_(1, chosen, said.reshape(chosen.shape))
