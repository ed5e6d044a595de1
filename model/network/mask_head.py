"""The mask feature branch: one map of E channels at stride 4, which every cap's kernel is laid on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

from torch import Tensor, nn
from torch.nn import functional as F

from fairyring.model.network.blocks import conv_norm_relu, start_small
from fairyring.model.network.coordinates import with_coordinates

COARSEST = 3
"""P5, which is given coordinates."""


class MaskHead(nn.Module):
    """P2…P5, each convolved and doubled in size until it has that of P2, summed, and mixed by a 1×1
    convolution.

    ``finest``: the level whose size the map has, 0 for P2; finer levels are left out.
    """

    def __init__(self, *, inputs: int, kernel_channels: int, finest: int = 0, channels: int = 128) -> None:
        super().__init__()
        self.finest = finest
        self.steps = nn.ModuleList(
            nn.ModuleList(
                conv_norm_relu(channels if nth else inputs + 2 * (level == COARSEST), channels)
                for nth in range(max(level - finest, 1))
            )
            for level in range(finest, COARSEST + 1)
        )
        self.mix = conv_norm_relu(channels, kernel_channels, kernel=1)
        start_small(self)

    def forward(self, pyramid: Sequence[Tensor], origins: Tensor, *, extent: tuple[int, int]) -> Tensor:
        """[P2, P3, P4, P5] → (B, E, h, w). ``origins`` and ``extent``: see ``with_coordinates``."""
        total = None
        for level, steps in enumerate(self.steps, self.finest):
            x = pyramid[level]
            if level == COARSEST:
                x = with_coordinates(x, origins, extent=extent)
            for step in cast("nn.ModuleList", steps):
                x = step(x)
                if level > self.finest:
                    x = F.interpolate(x, scale_factor=2.0, mode="bilinear")
            total = x if total is None else total + x
        return self.mix(total)
