"""The one block that the heads are built of."""

from __future__ import annotations

from torch import nn

from fairyring.model.network.config import GROUPS


def conv_norm_relu(inputs: int, outputs: int, *, kernel: int = 3) -> nn.Sequential:
    """Convolution without bias, group norm of 32 groups, ReLU: (B, inputs, h, w) → (B, outputs, h, w)."""
    return nn.Sequential(
        nn.Conv2d(inputs, outputs, kernel, padding=kernel // 2, bias=False),
        nn.GroupNorm(GROUPS, outputs),
        nn.ReLU(inplace=True),
    )


def start_small(module: nn.Module) -> None:
    """Samples the weights of every convolution from a normal distribution of σ 0.01, as SOLOv2 does."""
    for part in module.modules():
        if isinstance(part, nn.Conv2d | nn.Linear):
            nn.init.normal_(part.weight, std=0.01)
            if part.bias is not None:
                nn.init.zeros_(part.bias)
