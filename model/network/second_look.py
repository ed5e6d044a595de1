"""A second look at every cap that was found: how good its mask is, and where its whole ellipse lies.

Each cap is seen in a square window about its mask, twice as wide: the photo, its own mask and those of
others, and the network's maps of the place, together with the kernel of the grid cell that found it and the
score. The mask's quality is its IoU with what is visible of the cap (Huang et al., Mask Scoring R-CNN, CVPR
2019). The whole ellipse comes as a normal distribution of five numbers, relative to the window.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor, nn
from torch.nn import functional as F

from fairyring.model.network.blocks import conv_norm_relu
from fairyring.model.network.config import NetworkConfig
from fairyring.model.network.point_rend import PointMaps
from fairyring.model.network.point_sampling import sample_maps

SIDE = 32
"""Pixels a side of a window as it is seen; its maps are sampled at half of them."""
LAYERS = 5
"""Red, green, blue, own mask, others' masks."""
PARAMETERS = 5
"""x and y of the centre from the window's, in half windows; log of the radius over half the mask's longer
side; u and v, as in ``model.geometry.ellipse_parameters``."""
MOST_LOG_ROOT = 6.0
"""No parameter is held to be known better than to exp(-this)."""
MOST_ODDS = 10.0
KNOWN = 64
"""Numbers that the kernel is brought down to."""


class Windows(NamedTuple):
    """n found caps, each in its window."""

    layers: Tensor
    """(n, LAYERS, SIDE, SIDE): the photo from -1 to 1, and probabilities."""
    places: Tensor
    """(n, 3): x and y of the window's middle, and half its width: the mask's longer side; pixels of the
    input."""
    owners: Tensor
    """(n,): index of each cap's input in the batch."""
    kernels: Tensor
    """(n, E)."""
    scores: Tensor
    """(n,): raw, 0 to 1."""


class Said(NamedTuple):
    """What the second look says of n caps."""

    quality: Tensor
    """(n,) logits of the expected IoU of the mask."""
    mean: Tensor
    """(n, PARAMETERS)."""
    root: Tensor
    """(n, PARAMETERS, PARAMETERS): lower triangle L with the precision L · Lᵀ."""


class SecondLook(nn.Module):
    """Some convolutions over the windows, and a perceptron."""

    quality_line: Tensor
    """(2,): slope and shift by which logits of the quality become calibrated."""
    spread: Tensor
    """(PARAMETERS,): factors on the standard deviations, by which they become calibrated."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        width = config.second_look
        self.stride = 4 * config.reduction
        self.photo = nn.Conv2d(LAYERS, width, 4, stride=2, padding=1)
        self.fine = nn.Conv2d(config.point_channels, width, 1)
        self.semantic = nn.Conv2d(config.point_channels, width, 1)
        self.cap = nn.Sequential(
            conv_norm_relu(3 * width, 2 * width),
            nn.MaxPool2d(2),
            conv_norm_relu(2 * width, 2 * width),
            nn.MaxPool2d(2),
            conv_norm_relu(2 * width, 2 * width),
        )
        self.kernel = nn.Linear(config.kernel_channels, KNOWN)
        flat = 2 * width * (SIDE // 8) ** 2
        self.first = nn.Linear(flat + KNOWN + 2, 6 * width)
        self.second = nn.Linear(6 * width, 6 * width)
        self.quality = nn.Linear(6 * width, 1)
        self.mean = nn.Linear(6 * width, PARAMETERS)
        self.root = nn.Linear(6 * width, PARAMETERS * (PARAMETERS + 1) // 2)
        for last in (self.quality, self.mean, self.root):
            nn.init.normal_(last.weight, std=0.01)
            nn.init.zeros_(last.bias)
        self.register_buffer("quality_line", torch.tensor([1.0, 0.0]))
        self.register_buffer("spread", torch.ones(PARAMETERS))

    def forward(self, maps: PointMaps, windows: Windows) -> Said:
        """``maps`` of the whole batch, of n ≥ 1 windows."""
        points = _points_in(windows.places)
        owners = windows.owners.repeat_interleave(points.shape[1])
        around = [
            self._sampled(self.fine, maps.fine, owners, points, stride=self.stride),
            self._sampled(self.semantic, maps.semantic, owners, points, stride=4 * self.stride),
        ]
        seen = self.cap(F.relu(torch.cat([self.photo(windows.layers), *around], dim=1)))
        odds = torch.logit(windows.scores, eps=1e-4) / MOST_ODDS
        size = (windows.places[:, 2] / self.stride).clamp(min=1e-3).log()
        known = F.relu(self.kernel(windows.kernels))
        x = F.relu(self.first(torch.cat([seen.flatten(1), known, odds[:, None], size[:, None]], dim=1)))
        x = F.relu(self.second(x))
        return Said(self.quality(x)[:, 0], self.mean(x), _triangle(self.root(x)))

    @staticmethod
    def _sampled(layer: nn.Conv2d, maps: Tensor, owners: Tensor, points: Tensor, *, stride: float) -> Tensor:
        """(n, width, SIDE / 2, SIDE / 2), what a layer of 1 × 1 makes of maps (B, channels, h, w), at points
        (n, (SIDE / 2)², 2).

        The weights of a sample sum to 1, so it comes to the same whether samples are taken before the layer
        or after it; whichever leaves it less to do.
        """
        few = owners.numel() < maps.shape[0] * maps.shape[2] * maps.shape[3]
        values = sample_maps(maps if few else layer(maps), owners, points.reshape(-1, 2), stride=stride)
        values = values.reshape(len(points), SIDE // 2, SIDE // 2, -1).permute(0, 3, 1, 2)
        return layer(values) if few else values

    def calibrated_quality(self, said: Said) -> Tensor:
        """(n,), the expected IoU, 0 to 1."""
        slope, shift = self.quality_line.tolist()
        return (said.quality * slope + shift).sigmoid()

    def calibrated_covariance(self, said: Said) -> Tensor:
        """(n, PARAMETERS, PARAMETERS)."""
        covariance = torch.cholesky_inverse(said.root)
        return covariance * self.spread[:, None] * self.spread


def gaussian_loss(said: Said, true: Tensor) -> Tensor:
    """(n,): minus the logarithm of the probability density of ``true`` (n, PARAMETERS), but for a constant.

    ½ |Lᵀ (x − μ)|² − Σ log L_ii.
    """
    away = (true - said.mean).float()
    scaled = (said.root.float().mT @ away[..., None])[..., 0]
    return scaled.square().sum(1) / 2 - said.root.diagonal(dim1=1, dim2=2).log().sum(1)


def _points_in(places: Tensor) -> Tensor:
    """(n, (SIDE / 2)², 2): x, y of the middles of the cells of each window (n, 3), row after row."""
    count = SIDE // 2
    along = (torch.arange(count, device=places.device) + 0.5) / count * 2 - 1
    grid = torch.stack(torch.meshgrid(along, along, indexing="xy"), dim=2).reshape(1, -1, 2)
    return places[:, None, :2] + grid * places[:, None, 2:]


def _triangle(values: Tensor) -> Tensor:
    """(n, 15) → (n, 5, 5) lower triangles with a diagonal above 0."""
    rows, columns = torch.tril_indices(PARAMETERS, PARAMETERS, device=values.device)
    root = values.new_zeros(len(values), PARAMETERS, PARAMETERS)
    on_diagonal = rows == columns
    held = torch.where(on_diagonal, (values + 1).clamp(-2, MOST_LOG_ROOT).exp(), values)
    root[:, rows, columns] = held
    return root
