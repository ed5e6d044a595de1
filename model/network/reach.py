"""How far from its grid cell a cap may lie: what a kernel says of pixels further away is not asked."""

from __future__ import annotations

import torch
from torch import Tensor

from fairyring.model.network.config import NetworkConfig

REACH = 2 / 3
"""Of the largest √(box area) of a level: half of it, the way from cell to mass centre, and some for long
caps."""
FAR = -20.0
"""The logit of what cannot be part of a cap."""


def reach_of(config: NetworkConfig, level: int) -> float:
    """Photo pixels to each side of the middle of a cell of this level."""
    return REACH * config.scale_ranges[level][1] * config.reduction


def middles_of(held: Tensor) -> Tensor:
    """Of the cells that are True: (rows, columns) → (n, 2), x and y as shares of the input's sides."""
    rows, columns = held.nonzero().unbind(1)
    return torch.stack([(columns + 0.5) / held.shape[1], (rows + 0.5) / held.shape[0]], dim=1)


def within_reach(logits: Tensor, middles: Tensor, reach: Tensor) -> Tensor:
    """(n, h, w) logits, FAR where a pixel is further than ``reach`` (n,) beside or above ``middles`` (n, 2).

    ``reach`` is in pixels of the logits. SOLOv2 looks at the whole input instead: kernels learnt on crops
    then fail on photos, where there are more caps to tell one from.
    """
    height, width = logits.shape[1:]
    x = torch.arange(width, device=logits.device) + 0.5
    y = torch.arange(height, device=logits.device) + 0.5
    beside = (x - middles[:, :1] * width).abs() > reach[:, None]
    above = (y - middles[:, 1:] * height).abs() > reach[:, None]
    return logits.masked_fill(beside[:, None, :] | above[:, :, None], FAR)
