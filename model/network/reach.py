"""How far from its grid cell a cap may lie; a kernel's logits further away are ignored."""

from __future__ import annotations

import torch
from torch import Tensor

from fairyring.model.network.config import NetworkConfig

REACH = 2 / 3
"""Reach as a share of a level's largest √(box area): half of that, the way from the cell to the mass centre,
and some for long caps."""
FAR = -20.0
"""Logit of a pixel that is out of reach."""


def reach_of(config: NetworkConfig, level: int) -> float:
    """Reach of a level in photo pixels, to each side of a cell's middle."""
    return REACH * config.scale_ranges[level][1] * config.reduction


def middles_of(held: Tensor) -> Tensor:
    """Middles of the cells that are True, (..., rows, columns) → (n, 2): x, y as shares of the sides."""
    rows, columns = held.nonzero()[:, -2:].unbind(1)
    return torch.stack([(columns + 0.5) / held.shape[-1], (rows + 0.5) / held.shape[-2]], dim=1)


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
