"""PR-SOLOv2 (section 4): SOLOv2 with PointRend, from photos to what the losses and the decoder read."""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor, nn
from torch.nn import functional as F

from fairyring.model.network.backbone import build_backbone, normalisation_of
from fairyring.model.network.category_head import CategoryHead
from fairyring.model.network.config import LEVELS, NetworkConfig
from fairyring.model.network.coordinates import with_coordinates
from fairyring.model.network.fpn import FeaturePyramid
from fairyring.model.network.kernel_head import KernelHead
from fairyring.model.network.mask_head import MaskHead
from fairyring.model.network.point_rend import PointHead, PointMaps
from fairyring.model.network.second_look import SecondLook
from fairyring.model.network.semantic_point_rend import SemanticPointRend, SharpFeature
from fairyring.model.network.targets import grid_shape

P4_LEVEL = 2


class Outputs(NamedTuple):
    """The network's outputs for a batch of B inputs."""

    categories: list[Tensor]
    """Category logits (B, rows, columns) of each of P2…P6."""
    kernels: list[Tensor]
    """Kernels (B, E, rows, columns) of each of P2…P6."""
    feature: Tensor
    """Mask feature (B, E, h, w) at ``NetworkConfig.mask_stride``."""
    point_maps: PointMaps | None
    """Maps for the points of reading A; None without it."""
    sharp: SharpFeature | None
    """The sharpened mask feature of reading B; None without it."""


class PRSOLOv2(nn.Module):
    """The network: (B, 3, H, W) RGB bytes, H and W multiples of ``config.multiple`` → `Outputs`."""

    mean: Tensor
    std: Tensor
    calibration: Tensor
    """(2,): slope and shift of ``model.calibration``, by which scores become probabilities."""
    rim: Tensor
    """Scalar added to a mask's logits: how much further out people draw rims than it learnt, which rendered
    beds cannot teach; 0 where it learnt from what people drew."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.config = config
        self.backbone = build_backbone(config.backbone)
        width = config.fpn_channels
        self.fpn = FeaturePyramid(self.backbone.channels, width)
        self.category_head = CategoryHead(
            inputs=width, channels=config.head_channels, convs=config.head_convs
        )
        self.kernel_head = KernelHead(
            inputs=width,
            channels=config.head_channels,
            convs=config.head_convs,
            kernel_channels=config.kernel_channels,
        )
        finest = P4_LEVEL if config.point_rend == "semantic" else 0
        self.mask_head = MaskHead(inputs=width, kernel_channels=config.kernel_channels, finest=finest)
        self.point_head = PointHead(config) if config.point_rend == "instance" else None
        self.sharpen = SemanticPointRend(config) if config.point_rend == "semantic" else None
        self.second_look = SecondLook(config) if config.second_look else None
        mean, std = normalisation_of(config.backbone)
        # No weights file holds these: they are there also where the rest is built without memory.
        self.register_buffer("mean", torch.tensor(mean, device="cpu").view(1, 3, 1, 1), persistent=False)
        self.register_buffer("calibration", torch.tensor([1.0, 0.0]))
        self.register_buffer("rim", torch.tensor(0.0))
        self.register_buffer("std", torch.tensor(std, device="cpu").view(1, 3, 1, 1), persistent=False)

    def forward(self, photos: Tensor, origins: Tensor) -> Outputs:
        """``photos`` (B, 3, H, W) uint8 or float 0…255; ``origins`` (B, 2): see ``with_coordinates``."""
        extent = (photos.shape[-2], photos.shape[-1])
        photos = photos.to(torch.float32, memory_format=torch.channels_last, copy=True)
        photos = photos.sub_(255 * self.mean).mul_(1 / (255 * self.std))
        reduced = F.avg_pool2d(photos, self.config.reduction) if self.config.reduction > 1 else photos
        pyramid = self.fpn(self.backbone(reduced))
        categories, kernels = self._heads(pyramid, origins, extent)
        feature = self.mask_head(pyramid, origins, extent=extent)
        sharp = self.sharpen(feature, pyramid) if self.sharpen else None
        feature = sharp.feature if sharp else feature
        return Outputs(
            categories=categories,
            kernels=kernels,
            feature=feature,
            point_maps=self.point_head.maps(photos, pyramid, feature) if self.point_head else None,
            sharp=sharp,
        )

    def _heads(
        self, pyramid: list[Tensor], origins: Tensor, extent: tuple[int, int]
    ) -> tuple[list[Tensor], list[Tensor]]:
        """Category logits and kernels of every level."""
        height, width = extent
        categories, kernels = [], []
        for level, features in enumerate(_as_head_inputs(pyramid)):
            cells = F.interpolate(
                with_coordinates(features, origins, extent=extent),
                size=grid_shape(self.config, level, height=height, width=width),
                mode="bilinear",
            )
            kernels.append(self.kernel_head(cells))
            categories.append(self.category_head(cells[:, :-2]))
        assert len(kernels) == LEVELS
        return categories, kernels


def _as_head_inputs(pyramid: list[Tensor]) -> list[Tensor]:
    """P2 halved, P3, P4, P5, P6 at P5's size: strides 8, 8, 16, 32, 32."""
    halved = F.interpolate(pyramid[0], scale_factor=0.5, mode="bilinear")
    last = F.interpolate(pyramid[4], size=pyramid[3].shape[-2:], mode="bilinear")
    return [halved, *pyramid[1:4], last]
