"""Weights nobody trained: of a network that a test need not wait for, and that sees caps anywhere."""

from __future__ import annotations

from pathlib import Path

import torch
from msgspec.structs import replace

from fairyring.model.network.config import NetworkConfig
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.network.weights import save_weights

SMALL = NetworkConfig(
    reduction=1,
    fpn_channels=64,
    head_channels=64,
    head_convs=1,
    kernel_channels=32,
    grids=(16, 12, 8, 6, 4),
    point_channels=32,
    detail_channels=4,
)


def write_weights(path: Path, *, seed: int = 0, second_look: int = 0) -> str:
    """Writes them and returns their digest."""
    torch.manual_seed(seed)
    config = replace(SMALL, second_look=second_look)
    network = PRSOLOv2(config)
    with torch.no_grad():
        network.category_head.logit.bias.fill_(3.0)
        network.kernel_head.weights.weight.mul_(40)
    return save_weights(path, network.state_dict(), config, card={})


RECIPE = """
iterations = 3
batch = 1
warm_up = 0
rate = 1e-3

[crop]
side = 128

[network]
reduction = 1
fpn_channels = 64
head_channels = 64
head_convs = 1
kernel_channels = 32
grids = [16, 12, 8, 6, 4]
point_channels = 32
detail_channels = 4
"""
"""Trains a network of the same settings in a blink."""
