"""Decodes the network's outputs for one input: points-NMS, masks, mask scores, doubles, matrix NMS."""

from __future__ import annotations

from typing import NamedTuple

import torch
from msgspec import Struct
from torch import Tensor

from fairyring.model.network.config import NetworkConfig
from fairyring.model.network.doubles import parted
from fairyring.model.network.dynamic_conv import mask_logits
from fairyring.model.network.matrix_nms import matrix_nms, points_nms
from fairyring.model.network.pr_solov2 import Outputs
from fairyring.model.network.reach import middles_of, reach_of, within_reach

LEVEL_STRIDES = (8, 8, 16, 32, 32)
"""A mask of no more cells than this, at a mask stride of 4 photo pixels, is dropped."""

LESS = 0.5
"""What a cap counts for that a mask held among others, beside those that have a mask of their own."""


class DecodeConfig(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How instances are chosen; the reference's figures, but for the number kept."""

    window: int = 2
    """Window of points-NMS, grid cells; 1 means none."""
    least_cell_score: float = 0.1
    most_before_nms: int = 500
    least_score: float = 0.05
    most: int = 500
    """Most instances of an image: beds hold 250 caps and more."""


class Instances(NamedTuple):
    """K instances of one input, in falling order of score."""

    scores: Tensor
    """(K,)."""
    kernels: Tensor
    """(K, E)."""
    logits: Tensor
    """(K, h, w), at the mask stride; above 0 is cap."""


class _Candidates(NamedTuple):
    """The n grid cells that may hold a cap."""

    scores: Tensor
    """(n,)."""
    kernels: Tensor
    """(n, E)."""
    least: Tensor
    """(n,): cells of the mask that a mask must have more of."""
    middles: Tensor
    """(n, 2): x, y of the grid cells' middles, as shares of the input's width and height."""
    reach: Tensor
    """(n,): photo pixels around the middle beyond which no cap of this level lies."""


def least_cells(config: NetworkConfig, level: int) -> float:
    """Cells of the mask that a mask of this level must have more of."""
    return LEVEL_STRIDES[level] / config.reduction**2


def decode(outputs: Outputs, image: int, config: NetworkConfig, settings: DecodeConfig) -> Instances:
    """The instances of input ``image`` of the batch."""
    found = _candidates(outputs, image, config, settings)
    owners = torch.zeros(len(found.kernels), dtype=torch.int64, device=found.kernels.device)
    logits = mask_logits(outputs.feature[image : image + 1], found.kernels, owners)
    logits = within_reach(logits, found.middles, found.reach / config.mask_stride)
    masks = logits > 0
    area = masks.flatten(1).sum(1)
    inside = (logits.sigmoid() * masks).flatten(1).sum(1) / area.clamp(min=1)
    scores = torch.where(area > found.least, found.scores * inside, 0.0)
    order = scores.topk(min(settings.most_before_nms, int((scores > 0).sum()))).indices
    logits, owners = parted(logits[order])
    order = order[owners]
    is_whole = owners.bincount()[owners] == 1
    scores = _suppressed(logits > 0, scores[order], weight=torch.where(is_whole, 1.0, LESS))
    kept = scores.topk(min(settings.most, int((scores >= settings.least_score).sum()))).indices
    return Instances(scores[kept], found.kernels[order[kept]], logits[kept])


def _suppressed(masks: Tensor, scores: Tensor, *, weight: Tensor) -> Tensor:
    """Scores (n,) after matrix NMS of masks (n, h, w), in which each counts as its score times its weight."""
    weighted, order = (scores * weight).sort(descending=True, stable=True)
    lowered = torch.empty_like(scores)
    lowered[order] = matrix_nms(masks[order], weighted)
    return lowered / weight


def _candidates(outputs: Outputs, image: int, config: NetworkConfig, settings: DecodeConfig) -> _Candidates:
    parts = []
    for level, logits in enumerate(outputs.categories):
        peaks = points_nms(logits[image : image + 1].sigmoid(), window=settings.window)[0]
        held = peaks > settings.least_cell_score
        scores = peaks[held]
        parts.append(
            _Candidates(
                scores=scores,
                kernels=outputs.kernels[level][image].permute(1, 2, 0)[held],
                least=torch.full_like(scores, least_cells(config, level)),
                middles=middles_of(held),
                reach=torch.full_like(scores, reach_of(config, level)),
            )
        )
    return _Candidates(*(torch.cat(part) for part in zip(*parts, strict=True)))
