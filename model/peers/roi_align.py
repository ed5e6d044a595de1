"""RoIAlign (He et al., ICCV 2017): the features of boxes, each as a grid of its own."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor

from fairyring.model.network.point_sampling import sample_maps

SAMPLES = 2
"""Samples a side of each cell of a box's grid; their mean is the cell's."""
CANONICAL = 224.0
"""A box of this side, pixels of the network's input, is read from P4 (Lin et al., CVPR 2017, Eq. 1)."""


def roi_align(maps: Tensor, owners: Tensor, boxes: Tensor, *, size: int, stride: float) -> Tensor:
    """(B, C, h, w), (n,) map of each box, (n, 4) boxes in photo pixels → (n, C, size, size).

    Bilinear samples, SAMPLES² a cell, without rounding any coordinate; beyond a map's outermost middles its
    values hold on. ``stride``: photo pixels a cell of the map.
    """
    count = size * SAMPLES
    steps = (torch.arange(count, device=boxes.device) + 0.5) / count
    x = boxes[:, :1] + steps * (boxes[:, 2:3] - boxes[:, :1])
    y = boxes[:, 1:2] + steps * (boxes[:, 3:] - boxes[:, 1:2])
    points = torch.stack(
        [x[:, None, :].expand(-1, count, -1), y[:, :, None].expand(-1, -1, count)], dim=-1
    ).reshape(-1, 2)
    values = sample_maps(maps, owners.repeat_interleave(count * count), points, stride=stride)
    cells = values.reshape(len(boxes), size, SAMPLES, size, SAMPLES, maps.shape[1])
    return cells.mean((2, 4)).permute(0, 3, 1, 2)


def pyramid_align(
    pyramid: Sequence[Tensor], owners: Tensor, boxes: Tensor, *, size: int, reduction: int
) -> Tensor:
    """``roi_align`` of each box on the level of P2…P5 that suits its size → (n, C, size, size)."""
    side = (boxes[:, 2:] - boxes[:, :2]).clamp(min=1e-3).prod(1).sqrt() / reduction
    levels = (2 + (side / CANONICAL).log2()).floor().clamp(0, len(pyramid) - 1).long()
    aligned = pyramid[0].new_zeros(len(boxes), pyramid[0].shape[1], size, size)
    for level, maps in enumerate(pyramid):
        chosen = (levels == level).nonzero()[:, 0]
        if len(chosen):
            stride = 4 * reduction * 2**level
            some = roi_align(maps, owners[chosen], boxes[chosen], size=size, stride=stride)
            aligned = aligned.index_copy(0, chosen, some)
    return aligned
