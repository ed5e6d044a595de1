"""The category branch: how likely a cap is centred in a grid cell."""

from __future__ import annotations

import math
from itertools import pairwise

from torch import Tensor, nn

from fairyring.model.network.blocks import conv_norm_relu, start_small

PRIOR = 0.01
"""Share of cells that hold a cap before anything is learnt: many empty ones do not drown the loss."""


class CategoryHead(nn.Module):
    """A tower of 3×3 convolutions and a last one to one logit, shared by all levels."""

    def __init__(self, *, inputs: int, channels: int, convs: int) -> None:
        super().__init__()
        widths = [inputs, *([channels] * convs)]
        self.tower = nn.Sequential(*(conv_norm_relu(a, b) for a, b in pairwise(widths)))
        self.logit = nn.Conv2d(channels, 1, 3, padding=1)
        start_small(self)
        nn.init.constant_(self.logit.bias, -math.log((1 - PRIOR) / PRIOR))  # pyright: ignore

    def forward(self, cells: Tensor) -> Tensor:
        """(B, inputs, rows, columns) → logits (B, rows, columns)."""
        return self.logit(self.tower(cells)).squeeze(1)
