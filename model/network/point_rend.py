"""PointRend, reading A: a small network decides for single points whether they are on a cap.

Kirillov et al., PointRend (CVPR 2020). A point sees P2 and P4 (the paper's 2nd and 4th layer), the coarse
logit, and which cap is asked about: the mask feature there times the cap's kernel, and where in the cap's
box the point lies. With detail channels it sees the photo itself, too.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor, nn
from torch.nn import functional as F

from fairyring.model.network.blocks import start_small
from fairyring.model.network.config import NetworkConfig
from fairyring.model.network.point_sampling import sample_maps

CUE_CHANNELS = 64
LAYERS = 3
DETAIL_STRIDE = 2


class PointMaps(NamedTuple):
    """Feature maps that the points of an image are sampled from; made once an image."""

    fine: Tensor
    """(B, point channels, h, w): P2 after its share of the first layer."""
    semantic: Tensor
    """(B, point channels, h, w): P4 after its share of the first layer."""
    detail: Tensor | None
    """(B, detail channels, H / 2, W / 2) of an input of H × W photo pixels."""
    feature: Tensor
    """(B, E, h, w): the mask feature."""


class Queries(NamedTuple):
    """P points to decide on."""

    points: Tensor
    """(P, 2): x, y, photo pixels."""
    owners: Tensor
    """(P,): index of each point's image."""
    kernels: Tensor
    """(P, E): kernel of the cap that is asked about."""
    boxes: Tensor
    """(P, 4): x, y, width, height of that cap, photo pixels."""
    coarse: Tensor
    """(P,): that cap's coarse logit at the point."""


class Detail(nn.Module):
    """Two convolutions over the photo itself: (B, 3, H, W) → (B, channels, H / 2, W / 2)."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        # Of an even kernel the middle stays where ``sample_maps`` looks for it.
        self.first = nn.Conv2d(3, channels, 4, stride=DETAIL_STRIDE, padding=1)
        self.second = nn.Conv2d(channels, channels, 3, padding=1)

    def forward(self, photos: Tensor) -> Tensor:
        """(B, 3, H, W) → (B, channels, H / 2, W / 2)."""
        return F.relu(self.second(F.relu(self.first(photos), inplace=True)), inplace=True)


class PointHead(nn.Module):
    """A perceptron of three layers whose input is joined by the coarse logit again at each."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.reduction, self.mask_stride = config.reduction, config.mask_stride
        channels = config.point_channels
        # A linear layer of values between pixels is those values of the layer: half of it runs once an image.
        self.fine = nn.Conv2d(config.fpn_channels, channels, 1, bias=False)
        self.semantic = nn.Conv2d(config.fpn_channels, channels, 1, bias=False)
        self.detail = Detail(config.detail_channels) if config.detail_channels else None
        self.cue = nn.Linear(config.kernel_channels, CUE_CHANNELS)
        self.first = nn.Linear(CUE_CHANNELS + 3 + config.detail_channels, channels)
        later = [nn.Linear(channels + 1, channels) for _ in range(LAYERS - 1)]
        self.later = nn.ModuleList(later)
        self.last = nn.Linear(channels + 1, 1)
        for layer in (self.fine, self.semantic, self.first, *later):
            nn.init.kaiming_normal_(layer.weight, nonlinearity="relu")
        start_small(self.last)

    def maps(self, photos: Tensor, pyramid: list[Tensor], feature: Tensor) -> PointMaps:
        """``photos`` (B, 3, H, W) normalised; ``pyramid`` P2…P6; ``feature`` (B, E, h, w)."""
        return PointMaps(
            fine=self.fine(pyramid[0]),
            semantic=self.semantic(pyramid[2]),
            detail=self.detail(photos) if self.detail else None,
            feature=feature,
        )

    def forward(self, maps: PointMaps, queries: Queries) -> Tensor:
        """Logits (P,): above 0 the point is on the cap."""
        points, owners, kernels, boxes, coarse = queries
        asked = sample_maps(maps.feature, owners, points, stride=self.mask_stride) * kernels
        place = (points - boxes[:, :2]) / boxes[:, 2:].clamp(min=1.0) * 2 - 1
        inputs = [self.cue(asked), place, coarse[:, None]]
        if maps.detail is not None:
            inputs.append(sample_maps(maps.detail, owners, points, stride=DETAIL_STRIDE))
        x = self.first(torch.cat(inputs, dim=1))
        x = x + sample_maps(maps.fine, owners, points, stride=4 * self.reduction)
        x = F.relu(x + sample_maps(maps.semantic, owners, points, stride=16 * self.reduction))
        for layer in self.later:
            x = F.relu(layer(torch.cat([x, coarse[:, None]], dim=1)))
        return self.last(torch.cat([x, coarse[:, None]], dim=1)).squeeze(1)
