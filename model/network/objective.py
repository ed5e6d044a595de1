"""The whole loss of a batch of inputs and their caps: Eq. 1, and the loss of the points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import torch
from torch import Tensor

from fairyring.model.network.boxes import boxes_of, with_margin
from fairyring.model.network.config import NetworkConfig
from fairyring.model.network.dynamic_conv import mask_logits
from fairyring.model.network.losses import DICE_WEIGHT, dice_loss, focal_loss, point_loss
from fairyring.model.network.point_rend import Queries
from fairyring.model.network.point_sampling import sample_maps, training_points
from fairyring.model.network.pr_solov2 import Outputs, PRSOLOv2
from fairyring.model.network.reach import middles_of, reach_of, within_reach
from fairyring.model.network.targets import IGNORED

POINTS = 196
"""Points sampled on each cap (PointRend's training default)."""


@dataclass(frozen=True, kw_only=True)
class Caps:
    """The n caps of one input."""

    masks: Tensor
    """(n, H, W) uint8 at photo pixels: 1 on the visible cap."""
    ignored: Tensor
    """(H, W) bool at photo pixels: where it is not said whether there is a cap."""
    wholes: Tensor
    """(n, 5) float64: the whole ellipses by ``model.geometry.ellipse_parameters``; NaN where not known."""


@dataclass(frozen=True, kw_only=True)
class Batch:
    """B inputs of one size and their N caps, those of the first input first.

    Each of its parts is one tensor: hundreds of small ones take longer to hand over than to learn from.
    """

    photos: Tensor
    """(B, 3, H, W) uint8, RGB."""
    origins: Tensor
    """(B, 2): see ``with_coordinates``."""
    counts: list[int]
    """How many caps each input has; N in all."""
    masks: Tensor
    """(N, H, W) uint8 at photo pixels: 1 on the visible cap."""
    targets: Tensor
    """(N, h, w) float in [0, 1]: the mask at the mask feature's stride, soft or binary."""
    cells: list[Tensor]
    """For each level (B, rows, columns) int64, which of the N caps each cell learns: see
    ``model.network.targets``."""
    ignored: Tensor
    """(B, H, W) bool at photo pixels: where it is not said whether there is a cap."""
    wholes: Tensor
    """(N, 5) float64: the whole ellipses by ``model.geometry.ellipse_parameters``; NaN where not known."""

    @property
    def caps(self) -> list[Caps]:
        """Those of each input."""
        masks, wholes = self.masks.split(self.counts), self.wholes.split(self.counts)
        return [
            Caps(masks=mine, ignored=ignored, wholes=known)
            for mine, ignored, known in zip(masks, self.ignored, wholes, strict=True)
        ]

    def to(self, device: torch.device) -> Batch:
        """The same batch on another device; the whole ellipses, read by numpy alone, stay where they are."""
        return Batch(
            photos=self.photos.to(device),
            origins=self.origins.to(device),
            counts=self.counts,
            masks=self.masks.to(device),
            targets=self.targets.to(device),
            cells=[cells.to(device) for cells in self.cells],
            ignored=self.ignored.to(device),
            wholes=self.wholes,
        )


class Losses(NamedTuple):
    """The terms of the loss, scalars; each is 0 where nothing of its kind is in the batch."""

    category: Tensor
    mask: Tensor
    points: Tensor

    @property
    def total(self) -> Tensor:
        """Eq. 1 with λ = 3, and the points' loss, which Eq. 1 leaves out, at weight 1."""
        return self.category + DICE_WEIGHT * self.mask + self.points


class _Positives(NamedTuple):
    """The P cells of a batch that hold a cap."""

    kernels: Tensor
    """(P, E)."""
    images: Tensor
    """(P,), rising."""
    caps: Tensor
    """(P,): index of the cap among all caps of the batch."""
    middles: Tensor
    """(P, 2): x, y of the cells' middles, as shares of the input's width and height."""
    reach: Tensor
    """(P,): photo pixels around the middle within which the cap is looked for."""


def losses_of(network: PRSOLOv2, outputs: Outputs, batch: Batch) -> Losses:
    """The losses of one forward pass over ``batch.photos``."""
    positives = _positives(outputs, batch, network.config)
    category = _category_loss(outputs, batch) / (len(positives.caps) + 1)
    logits = mask_logits(outputs.feature, positives.kernels, positives.images)
    logits = within_reach(logits, positives.middles, positives.reach / network.config.mask_stride)
    nothing = outputs.feature.sum() * 0
    mask = dice_loss(logits, batch.targets[positives.caps]).mean() if len(logits) else nothing
    points = nothing
    if outputs.point_maps is not None and len(logits):
        points = _instance_points(network, outputs, batch, positives, logits)
    if outputs.sharp is not None:
        points = _semantic_points(outputs, batch)
    return Losses(category, mask, points)


def _positives(outputs: Outputs, batch: Batch, config: NetworkConfig) -> _Positives:
    parts = []
    for level, cells in enumerate(batch.cells):
        held = cells >= 0
        images = held.nonzero()[:, 0]
        parts.append(
            _Positives(
                kernels=outputs.kernels[level].permute(0, 2, 3, 1)[held],
                images=images,
                caps=cells[held],
                middles=middles_of(held),
                reach=torch.full_like(images, reach_of(config, level), dtype=torch.float32),
            )
        )
    together = _Positives(*(torch.cat(part) for part in zip(*parts, strict=True)))
    order = together.images.argsort(stable=True)
    return _Positives(*(part[order] for part in together))


def _category_loss(outputs: Outputs, batch: Batch) -> Tensor:
    logits = torch.cat([level.flatten() for level in outputs.categories])
    cells = torch.cat([level.flatten() for level in batch.cells])
    counts = cells != IGNORED
    return focal_loss(logits[counts].float(), cells[counts] >= 0)


def _instance_points(
    network: PRSOLOv2, outputs: Outputs, batch: Batch, positives: _Positives, logits: Tensor
) -> Tensor:
    """Points of reading A, on one random positive cell a cap."""
    assert network.point_head is not None
    assert outputs.point_maps is not None
    device = logits.device
    shuffled = torch.randperm(len(logits), device=device)
    of_cap = torch.full((len(batch.masks),), -1, device=device)
    of_cap[positives.caps[shuffled]] = shuffled
    caps = (of_cap >= 0).nonzero().squeeze(1)
    chosen = of_cap[caps]
    coarse, stride = logits[chosen], network.config.mask_stride
    targets = batch.targets[caps]
    with torch.no_grad():
        # As prediction sees it: in cells of the mask, and with the window's margin to draw in.
        boxes = boxes_of(targets >= targets.amax((1, 2), keepdim=True).clamp(max=0.5)) * stride
        windows = with_margin(boxes, least=stride)
        points = training_points(coarse, windows, count=POINTS, stride=stride).reshape(-1, 2)
    each = torch.arange(len(caps), device=device).repeat_interleave(POINTS)
    queries = Queries(
        points=points,
        owners=positives.images[chosen][each],
        kernels=positives.kernels[chosen][each],
        boxes=boxes[each],
        coarse=sample_maps(coarse[:, None], each, points, stride=stride)[:, 0],
    )
    said = network.point_head(outputs.point_maps, queries)
    true = sample_maps(batch.masks[:, None], caps[each], points, stride=1)[:, 0]
    return point_loss(said, true)


def _semantic_points(outputs: Outputs, batch: Batch) -> Tensor:
    """Points of reading B: whether each is on any cap; those where it is not said are left out."""
    assert outputs.sharp is not None
    any_cap = torch.stack(
        [
            caps.masks.amax(0) if len(caps.masks) else batch.photos.new_zeros(batch.photos.shape[-2:])
            for caps in batch.caps
        ]
    )
    count = outputs.sharp.points.shape[1]
    owners = torch.arange(len(any_cap), device=any_cap.device).repeat_interleave(count)
    points = outputs.sharp.points.reshape(-1, 2)
    true = sample_maps(any_cap[:, None], owners, points, stride=1)[:, 0]
    x, y = points.long().unbind(1)
    unsaid = batch.ignored[owners, y, x] & (true == 0)
    return point_loss(outputs.sharp.logits.flatten()[~unsaid], true[~unsaid])
