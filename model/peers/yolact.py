"""YOLACT (Bolya et al., ICCV 2019): prototype masks of the whole photo, and for each box how to mix them."""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor, nn
from torch.nn import functional as F

from fairyring.model.network.config import NetworkConfig
from fairyring.model.peers.anchors import RATIOS, anchors_of, by_anchor
from fairyring.model.peers.boxes import decoded, quickly_suppressed, within
from fairyring.model.peers.pyramid import OnPyramid, conv
from fairyring.model.peers.seen import SeenCaps

SIZES = (24.0, 48.0, 96.0, 192.0, 384.0)
"""√area of the anchors of P3…P7, photo pixels."""
WEIGHTS = (10.0, 5.0)
"""See ``boxes.coded``: YOLACT's variances .1 and .2."""
PROTOTYPES = 32
MOST_OVERLAP, LEAST_SCORE, MOST_CAPS = 0.5, 0.05, 600


class Predicted(NamedTuple):
    """What the network says of a batch, for the same n anchors in every photo."""

    anchors: Tensor
    """(n, 4)."""
    likely: Tensor
    """(B, n, 2): logits of nothing and of a cap."""
    codes: Tensor
    """(B, n, 4): see ``boxes.coded``."""
    mixtures: Tensor
    """(B, n, PROTOTYPES): of each prototype from -1 to 1."""
    prototypes: Tensor
    """(B, PROTOTYPES, h, w), at ``YOLACT.mask_stride``."""
    anywhere: Tensor
    """(B, h, w): logits of any cap at P3, which training alone looks at."""


class YOLACT(OnPyramid):
    """The network of one category."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__(config)
        width, shapes = config.fpn_channels, len(RATIOS)
        self.head = conv(width, width)
        self.likely = nn.Conv2d(width, 2 * shapes, 3, padding=1)
        self.codes = nn.Conv2d(width, 4 * shapes, 3, padding=1)
        self.mixtures = nn.Conv2d(width, PROTOTYPES * shapes, 3, padding=1)
        self.before_doubling = nn.Sequential(*(conv(width, width) for _ in range(3)))
        self.after_doubling = nn.Sequential(conv(width, width), nn.Conv2d(width, PROTOTYPES, 1), nn.ReLU())
        self.anywhere = nn.Conv2d(width, 1, 1)

    @property
    def mask_stride(self) -> int:
        """Photo pixels a side of one cell of the prototypes: half of P3's."""
        return 4 * self.config.reduction

    def forward(self, photos: Tensor) -> Predicted:
        """``photos`` (B, 3, H, W), sides multiples of ``config.multiple``."""
        pyramid = self.pyramid(photos)
        levels = [*pyramid[1:], F.max_pool2d(pyramid[-1], 1, stride=2)]
        strides = [8 * self.config.reduction * 2**level for level in range(len(levels))]
        shapes = [(level.shape[-2], level.shape[-1]) for level in levels]
        anchors = anchors_of(shapes, strides=strides, sizes=SIZES, device=photos.device)
        heads = [self.head(level) for level in levels]
        doubled = F.interpolate(self.before_doubling(levels[0]), scale_factor=2, mode="bilinear")
        return Predicted(
            anchors=torch.cat(anchors),
            likely=by_anchor([self.likely(head) for head in heads], 2),
            codes=by_anchor([self.codes(head) for head in heads], 4),
            mixtures=by_anchor([self.mixtures(head) for head in heads], PROTOTYPES).tanh(),
            prototypes=self.after_doubling(doubled),
            anywhere=self.anywhere(levels[0])[:, 0],
        )

    @torch.inference_mode()
    def see(self, photo: Tensor) -> SeenCaps:
        """The caps of one photo (1, 3, H, W), sides multiples of ``config.multiple``."""
        height, width = photo.shape[-2:]
        predicted = self(photo)
        scores = predicted.likely[0].softmax(1)[:, 1]
        likely = (scores > LEAST_SCORE).nonzero()[:, 0]
        boxes = decoded(predicted.codes[0, likely], predicted.anchors[likely], weights=WEIGHTS)
        boxes = within(boxes, width=width, height=height)
        kept = quickly_suppressed(boxes, scores[likely], most_overlap=MOST_OVERLAP, most=MOST_CAPS)
        boxes, chosen = boxes[kept], likely[kept]
        masks = mixed(predicted.prototypes[0], predicted.mixtures[0, chosen])
        logits = [_in_box(mask, box, size=(height, width)) for mask, box in zip(masks, boxes, strict=True)]
        return SeenCaps(scores[chosen], boxes, logits)


def mixed(prototypes: Tensor, mixtures: Tensor) -> Tensor:
    """(k, h, w) prototypes and (n, k) mixtures → (n, h, w) mask logits (Eq. 1 of the paper)."""
    return torch.einsum("khw,nk->nhw", prototypes, mixtures)


def _in_box(mask: Tensor, box: Tensor, *, size: tuple[int, int]) -> Tensor:
    """The logits of a mask (h, w) on a grid that fills the box (4,), about a photo pixel a cell.

    ``size``: height and width of the photo that the mask covers.
    """
    extent = (box[2:] - box[:2]).clamp(min=1)
    columns, rows = (int(side) for side in extent.ceil().tolist())
    x = box[0] + (torch.arange(columns, device=box.device) + 0.5) / columns * extent[0]
    y = box[1] + (torch.arange(rows, device=box.device) + 0.5) / rows * extent[1]
    grid = torch.stack(torch.meshgrid(2 * y / size[0] - 1, 2 * x / size[1] - 1, indexing="ij")[::-1], dim=-1)
    return F.grid_sample(mask[None, None], grid[None], padding_mode="border", align_corners=False)[0, 0]
