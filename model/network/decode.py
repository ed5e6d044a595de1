"""From the network's outputs of one input to its instances: points-NMS, masks, their scores, matrix NMS."""

from __future__ import annotations

from typing import NamedTuple

import torch
from msgspec import Struct
from torch import Tensor

from model.network.config import NetworkConfig
from model.network.dynamic_conv import mask_logits
from model.network.matrix_nms import matrix_nms, points_nms
from model.network.pr_solov2 import Outputs

LEVEL_STRIDES = (8, 8, 16, 32, 32)
"""A mask of no more cells than this, at a mask stride of 4 photo pixels, is dropped."""


class DecodeConfig(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How instances are chosen; the reference's figures, but for the number kept."""

    window: int = 2
    """Of points-NMS, cells; 1 is none."""
    least_cell_score: float = 0.1
    most_before_nms: int = 500
    least_score: float = 0.05
    most: int = 500
    """Instances an image: beds hold 250 caps and more."""


class Instances(NamedTuple):
    """K instances of one input, in falling order of score."""

    scores: Tensor
    """(K,)."""
    kernels: Tensor
    """(K, E)."""
    logits: Tensor
    """(K, h, w), at the mask stride; above 0 is cap."""


def decode(outputs: Outputs, image: int, config: NetworkConfig, settings: DecodeConfig) -> Instances:
    """The instances of input ``image`` of the batch."""
    scores, kernels, least = _candidates(outputs, image, config, settings)
    owners = torch.zeros(len(kernels), dtype=torch.int64, device=kernels.device)
    logits = mask_logits(outputs.feature[image : image + 1], kernels, owners)
    masks = logits > 0
    area = masks.flatten(1).sum(1)
    inside = (logits.sigmoid() * masks).flatten(1).sum(1) / area.clamp(min=1)
    scores = torch.where(area > least, scores * inside, 0.0)
    order = scores.topk(min(settings.most_before_nms, int((scores > 0).sum()))).indices
    scores = matrix_nms(masks[order], scores[order])
    kept = scores.topk(min(settings.most, int((scores >= settings.least_score).sum()))).indices
    order = order[kept]
    return Instances(scores[kept], kernels[order], logits[order])


def _candidates(
    outputs: Outputs, image: int, config: NetworkConfig, settings: DecodeConfig
) -> tuple[Tensor, Tensor, Tensor]:
    """Scores (n,), kernels (n, E) and least areas (n,; mask cells) of the grid cells that may hold a cap."""
    scores, kernels, least = [], [], []
    for level, logits in enumerate(outputs.categories):
        peaks = points_nms(logits[image : image + 1].sigmoid(), window=settings.window)[0]
        held = peaks > settings.least_cell_score
        scores.append(peaks[held])
        kernels.append(outputs.kernels[level][image].permute(1, 2, 0)[held])
        least.append(torch.full_like(scores[-1], LEVEL_STRIDES[level] / config.reduction**2))
    return torch.cat(scores), torch.cat(kernels), torch.cat(least)
