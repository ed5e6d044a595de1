"""The kernel branch: for every grid cell, the weights of the 1×1 convolution that draws its cap's mask."""

from __future__ import annotations

from itertools import pairwise

from torch import Tensor, nn

from fairyring.model.network.blocks import conv_norm_relu, start_small


class KernelHead(nn.Module):
    """A tower of 3×3 convolutions and a last one to E weights, shared by all levels."""

    def __init__(self, *, inputs: int, channels: int, convs: int, kernel_channels: int) -> None:
        super().__init__()
        widths = [inputs + 2, *([channels] * convs)]
        self.tower = nn.Sequential(*(conv_norm_relu(a, b) for a, b in pairwise(widths)))
        self.weights = nn.Conv2d(channels, kernel_channels, 3, padding=1)
        start_small(self)

    def forward(self, cells: Tensor) -> Tensor:
        """(B, inputs + 2, rows, columns), coordinates last → (B, E, rows, columns)."""
        return self.weights(self.tower(cells))
