"""The masks that the network might draw for a cap at a place: of the kernels in the grid cells there."""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor

from fairyring.model.network.decode import least_cells
from fairyring.model.network.dynamic_conv import mask_logits
from fairyring.model.network.point_sampling import sample_maps
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.network.reach import reach_of, within_reach
from fairyring.model.predict.seen import SeenPiece

MOST = 8
"""Most grid cells that are asked for a mask."""


class Candidates(NamedTuple):
    """n masks of a piece; some may be empty or of no cap."""

    scores: Tensor
    """(n,): of the cell, times the mean probability inside the mask; 0 where too few cells are in it."""
    kernels: Tensor
    """(n, E)."""
    logits: Tensor
    """(n, h, w), at the mask stride; above 0 is cap."""


def candidates_at(network: PRSOLOv2, piece: SeenPiece, points: Tensor) -> Candidates:
    """The masks of every level's cells that hold one of the points, and of those around these.

    ``points`` (p, 2): x, y, the pixels of the piece. Of the cells only the MOST likeliest are asked.
    """
    config, outputs = network.config, piece.outputs
    cells = [
        _cells_near(logits.shape[-2:], points / _extent_of(piece, network)) for logits in outputs.categories
    ]
    likely = torch.cat(
        [
            logits[piece.index, near[:, 1], near[:, 0]].sigmoid()
            for logits, near in zip(outputs.categories, cells, strict=True)
        ]
    )
    asked = likely.topk(min(MOST, len(likely))).indices
    kernels, middles, reach, least = [], [], [], []
    for level, near in enumerate(cells):
        kernel = outputs.kernels[level]
        kernels.append(kernel[piece.index][:, near[:, 1], near[:, 0]].T)
        middles.append((near + 0.5) / near.new_tensor(kernel.shape[-2:]).flip(0))
        reach.append(middles[-1].new_full((len(near),), reach_of(config, level) / config.mask_stride))
        least.append(middles[-1].new_full((len(near),), least_cells(config, level)))
    weights = torch.cat(kernels)[asked]
    owners = torch.zeros(len(weights), dtype=torch.int64, device=weights.device)
    masks = mask_logits(outputs.feature[piece.index : piece.index + 1], weights, owners)
    masks = within_reach(masks, torch.cat(middles)[asked], torch.cat(reach)[asked])
    return Candidates(likely[asked] * _certainty(masks, torch.cat(least)[asked]), weights, masks)


def _cells_near(grid: torch.Size, points: Tensor) -> Tensor:
    """(n, 2) column and row of the cells at the points (p, 2), shares of the grid's sides, and around."""
    shape = torch.tensor([grid[1], grid[0]], device=points.device)
    cells = (points * shape).floor().long()
    around = torch.cartesian_prod(torch.arange(-1, 2), torch.arange(-1, 2)).to(points.device)
    near = (cells[:, None] + around).reshape(-1, 2).unique(dim=0)
    inside = (near >= 0) & (near < shape)
    return near[inside.all(1)]


def logits_at(candidates: Candidates, points: Tensor, *, stride: int) -> Tensor:
    """(n, p): each mask's logit at each of the points (p, 2), the pixels of the piece."""
    count, each = len(candidates.logits), len(points)
    owners = torch.arange(count, device=points.device).repeat_interleave(each)
    values = sample_maps(candidates.logits[:, None], owners, points.repeat(count, 1), stride=stride)
    return values.reshape(count, each)


def _extent_of(piece: SeenPiece, network: PRSOLOv2) -> Tensor:
    """Width and height of what the network was given for the piece: it is padded to whole multiples."""
    height, width = piece.outputs.feature.shape[-2:]
    stride = network.config.mask_stride
    return torch.tensor([width * stride, height * stride], device=piece.outputs.feature.device)


def _certainty(logits: Tensor, least: Tensor) -> Tensor:
    """(n,) mean probability inside each mask; 0 where it has no more cells than ``least`` (n,)."""
    masks = logits > 0
    area = masks.flatten(1).sum(1)
    inside = (logits.sigmoid() * masks).flatten(1).sum(1) / area.clamp(min=1)
    return torch.where(area > least, inside, 0.0)
