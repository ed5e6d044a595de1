"""Drawing the edge at photo pixels: each instance's logits, doubled again and again, seen anew where unclear.

PointRend's inference (Kirillov et al., CVPR 2020), on each instance's own window and never on whole images.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor
from torch.nn import functional as F  # noqa: N812

from model.network.boxes import main_boxes_of, with_margin
from model.network.decode import Instances
from model.network.point_rend import PointHead, PointMaps, Queries

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
    boxes = main_boxes_of(instances.logits > 0)
    windows = with_margin(boxes, least=1)
    corners, sides = windows[:, :2], windows[:, 2:].amax(1)
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
                points, chosen = _unclear(logits, at, stride=stride)
                each = torch.arange(len(logits), device=logits.device).repeat_interleave(chosen.shape[1])
                flat = logits.view(len(logits), -1)
                queries = Queries(
                    points=points,
                    owners=torch.full_like(each, image),
                    kernels=kernels[each],
                    boxes=frames[each],
                    coarse=flat.gather(1, chosen).flatten(),
                )
                flat.scatter_(1, chosen, head(maps, queries).reshape(chosen.shape))
        for index, (x, y), window in zip(of_side.tolist(), at.long().tolist(), logits, strict=True):
            drawn[index] = Drawn(x, y, window)
    return [one for one in drawn if one is not None]


def _windows(logits: Tensor, corners: Tensor, *, side: int) -> Tensor:
    """(n, h, w), (n, 2) → (n, side, side); beyond the map its outermost values hold on."""
    reach = torch.arange(side, device=logits.device)
    x = (corners[:, :1] + reach).clamp(0, logits.shape[2] - 1)
    y = (corners[:, 1:] + reach).clamp(0, logits.shape[1] - 1)
    each = torch.arange(len(logits), device=logits.device)[:, None, None]
    return logits[each, y[:, :, None], x[:, None, :]]


def _unclear(logits: Tensor, at: Tensor, *, stride: int) -> tuple[Tensor, Tensor]:
    """The points (n · k, 2) where windows (n, s, s) are nearest 0, and their places (n, k) in them.

    ``at`` (n, 2): the windows' first corners, photo pixels.
    """
    count, side = logits.shape[:2]
    flat = logits.view(count, -1)
    chosen = flat.abs().topk(min(POINTS_PER_SIDE * side, flat.shape[1]), dim=1, largest=False).indices
    where = torch.stack([chosen % side, chosen // side], dim=2)
    return (at[:, None] + (where.float() + 0.5) * stride).reshape(-1, 2), chosen
