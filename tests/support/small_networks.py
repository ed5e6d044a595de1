"""Networks small enough to build and run in a blink, shared by its tests and those of its training."""

from __future__ import annotations

from typing import Any

import torch
from msgspec.structs import replace

from fairyring.model.network.config import NetworkConfig
from fairyring.model.network.pr_solov2 import PRSOLOv2

TINY = NetworkConfig(
    reduction=1,
    fpn_channels=32,
    head_channels=64,
    head_convs=1,
    kernel_channels=32,
    point_channels=32,
    detail_channels=4,
)


def tiny(**changes: Any) -> PRSOLOv2:
    """A tiny network with the same random weights each time."""
    torch.manual_seed(0)
    return PRSOLOv2(replace(TINY, **changes))
