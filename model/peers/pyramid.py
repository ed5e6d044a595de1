"""What both systems share with PR-SOLOv2: how a photo becomes a feature pyramid."""

from __future__ import annotations

import torch
from torch import Tensor, nn
from torch.nn import functional as F

from fairyring.model.network.backbone import build_backbone, load_backbone, normalisation_of
from fairyring.model.network.config import NetworkConfig
from fairyring.model.network.fpn import FeaturePyramid
from fairyring.model.network.lite0 import imagenet_weights


class OnPyramid(nn.Module):
    """A network whose heads read a feature pyramid.

    The backbone starts from ImageNet weights where they are installed.
    """

    mean: Tensor
    std: Tensor

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.config = config
        self.backbone = build_backbone(config.backbone)
        state = imagenet_weights() if config.backbone == "lite0" else None
        if state is not None:
            load_backbone(self.backbone, state)
        self.fpn = FeaturePyramid(self.backbone.channels, config.fpn_channels)
        mean, std = normalisation_of(config.backbone)
        self.register_buffer("mean", 255 * torch.tensor(mean).view(1, 3, 1, 1), persistent=False)
        self.register_buffer("std", 255 * torch.tensor(std).view(1, 3, 1, 1), persistent=False)

    def pyramid(self, photos: Tensor) -> list[Tensor]:
        """(B, 3, H, W) RGB bytes, H and W multiples of ``config.multiple`` → P2…P6.

        Each (B, fpn_channels, h, w), at strides of 4, 8, 16, 32 and 64 times ``config.reduction``.
        """
        photos = (photos.float() - self.mean) / self.std
        reduced = F.avg_pool2d(photos, self.config.reduction) if self.config.reduction > 1 else photos
        return self.fpn(self.backbone(reduced))


def conv(inputs: int, outputs: int) -> nn.Sequential:
    """A 3×3 convolution and a ReLU."""
    return nn.Sequential(nn.Conv2d(inputs, outputs, 3, padding=1), nn.ReLU())
