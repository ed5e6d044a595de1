"""PointRend, reading B: as printed, before the mask branch. It sharpens the mask feature from P4's size to
P2's.

What is uncertain is whether a pixel is cap or soil. At the points where that is least clear the feature,
doubled in size, is replaced by what a perceptron makes of it, P2 and P4.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor, nn
from torch.nn import functional as F

from fairyring.model.network.config import NetworkConfig
from fairyring.model.network.point_sampling import sample_maps

COARSEST_STRIDE, STEPS = 16, 2
POINTS = 2048
"""How many points are replaced in each step, in each image."""


class SharpFeature(NamedTuple):
    """The mask feature, and what was said of the points on the way."""

    feature: Tensor
    """(B, E, h, w), at P2's size."""
    points: Tensor
    """(B, P, 2), photo pixels."""
    logits: Tensor
    """(B, P): cap or not."""


class SemanticPointRend(nn.Module):
    """(B, E, h / 4, w / 4) → (B, E, h, w)."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.reduction = config.reduction
        features, channels = config.kernel_channels, config.point_channels
        inputs = features + 2 * config.fpn_channels
        self.cap = nn.Conv2d(features, 1, 1)
        self.layers = nn.Sequential(
            nn.Linear(inputs, channels),
            nn.ReLU(),
            nn.Linear(channels, channels),
            nn.ReLU(),
            nn.Linear(channels, features),
        )

    def forward(self, feature: Tensor, pyramid: list[Tensor]) -> SharpFeature:
        """``feature`` at P4's size; ``pyramid`` P2…P6."""
        points, logits = [], []
        stride = COARSEST_STRIDE * self.reduction
        for _ in range(STEPS):
            feature, stride = F.interpolate(feature, scale_factor=2.0, mode="bilinear"), stride // 2
            cap = self.cap(feature).flatten(1)
            chosen = cap.abs().topk(min(POINTS, cap.shape[1]), dim=1, largest=False).indices
            width = feature.shape[-1]
            where = torch.stack([chosen % width, chosen // width], dim=2)
            points.append((where.float() + 0.5) * stride)
            logits.append(cap.gather(1, chosen))
            feature = self._replace(feature, pyramid, chosen, points[-1])
        return SharpFeature(feature, torch.cat(points, 1), torch.cat(logits, 1))

    def _replace(self, feature: Tensor, pyramid: list[Tensor], chosen: Tensor, points: Tensor) -> Tensor:
        """The feature with its pixels ``chosen`` (B, P) seen again; ``points`` (B, P, 2): their middles."""
        batch, channels = feature.shape[:2]
        index = chosen[:, None].expand(-1, channels, -1)
        old = feature.flatten(2).gather(2, index).transpose(1, 2)
        owners = torch.arange(batch, device=feature.device).repeat_interleave(chosen.shape[1])
        seen = [
            sample_maps(pyramid[level], owners, points.flatten(0, 1), stride=stride * self.reduction)
            for level, stride in ((0, 4), (2, 16))
        ]
        inputs = torch.cat([old, *(part.reshape(batch, -1, part.shape[1]) for part in seen)], dim=2)
        new = old + self.layers(inputs)
        return feature.flatten(2).scatter(2, index, new.transpose(1, 2)).reshape(feature.shape)
