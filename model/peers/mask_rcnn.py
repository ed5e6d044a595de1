"""Mask R-CNN (He et al., ICCV 2017) with a feature pyramid: proposals, then a box and a mask for each."""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor, nn

from fairyring.model.network.config import NetworkConfig
from fairyring.model.peers.anchors import RATIOS, anchors_of, by_anchor
from fairyring.model.peers.boxes import decoded, suppressed, within
from fairyring.model.peers.pyramid import OnPyramid, conv
from fairyring.model.peers.roi_align import pyramid_align
from fairyring.model.peers.seen import SeenCaps

SIZES = (16.0, 32.0, 64.0, 128.0, 256.0)
"""√area of the anchors of P2…P6, photo pixels: caps are smaller than the things of COCO."""
PROPOSAL_WEIGHTS, BOX_WEIGHTS = (1.0, 1.0), (10.0, 5.0)
BOX_GRID, MASK_GRID = 7, 14
CANDIDATES, PROPOSALS = 1000, 1000
"""Most candidates of a level before suppression, most proposals of a photo after it."""
MOST_OVERLAP_OF_PROPOSALS, MOST_OVERLAP = 0.7, 0.5
LEAST_SCORE, MOST_CAPS = 0.05, 600
HIDDEN = 512
"""Width of the box head's two layers."""


class Proposals(NamedTuple):
    """What the first stage says of a batch: for each photo the same anchors, of all levels in turn."""

    anchors: Tensor
    """(n, 4)."""
    likely: Tensor
    """(B, n): logits of a cap."""
    codes: Tensor
    """(B, n, 4): see ``boxes.coded``."""
    levels: Tensor
    """(n,): the level of each anchor."""


class MaskRCNN(OnPyramid):
    """The network of one category, its boxes told without regard to it."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__(config)
        width, shapes = config.fpn_channels, len(RATIOS)
        self.proposing = conv(width, width)
        self.likely = nn.Conv2d(width, shapes, 1)
        self.codes = nn.Conv2d(width, 4 * shapes, 1)
        self.box_head = nn.Sequential(
            nn.Flatten(),
            *(nn.Linear(width * BOX_GRID**2, HIDDEN), nn.ReLU()),
            *(nn.Linear(HIDDEN, HIDDEN), nn.ReLU()),
        )
        self.box_score, self.box_code = nn.Linear(HIDDEN, 1), nn.Linear(HIDDEN, 4)
        self.mask_head = nn.Sequential(
            *(conv(width, width) for _ in range(4)),
            *(nn.ConvTranspose2d(width, width, 2, stride=2), nn.ReLU()),
            nn.Conv2d(width, 1, 1),
        )
        for last in (self.likely, self.codes, self.box_score, self.box_code):
            nn.init.normal_(last.weight, std=0.01)

    def proposals(self, pyramid: list[Tensor]) -> Proposals:
        """The first stage, over P2…P6."""
        heads = [self.proposing(level) for level in pyramid]
        strides = [4 * self.config.reduction * 2**level for level in range(len(pyramid))]
        shapes = [(level.shape[-2], level.shape[-1]) for level in pyramid]
        anchors = anchors_of(shapes, strides=strides, sizes=SIZES, device=pyramid[0].device)
        counts = torch.tensor([len(level) for level in anchors], device=pyramid[0].device)
        return Proposals(
            anchors=torch.cat(anchors),
            likely=by_anchor([self.likely(head) for head in heads], 1)[..., 0],
            codes=by_anchor([self.codes(head) for head in heads], 4),
            levels=torch.arange(len(anchors), device=counts.device).repeat_interleave(counts),
        )

    def score_and_code(self, pyramid: list[Tensor], owners: Tensor, boxes: Tensor) -> tuple[Tensor, Tensor]:
        """The second stage of n boxes (n, 4) → logits of a cap (n,), codes (n, 4)."""
        aligned = pyramid_align(pyramid[:4], owners, boxes, size=BOX_GRID, reduction=self.config.reduction)
        hidden = self.box_head(aligned)
        return self.box_score(hidden)[:, 0], self.box_code(hidden)

    def mask_logits(self, pyramid: list[Tensor], owners: Tensor, boxes: Tensor) -> Tensor:
        """Masks of n boxes → (n, 28, 28) logits."""
        aligned = pyramid_align(pyramid[:4], owners, boxes, size=MASK_GRID, reduction=self.config.reduction)
        return self.mask_head(aligned)[:, 0]

    @torch.inference_mode()
    def see(self, photo: Tensor) -> SeenCaps:
        """The caps of one photo (1, 3, H, W), sides multiples of ``config.multiple``."""
        height, width = photo.shape[-2:]
        pyramid = self.pyramid(photo)
        boxes = best_proposals(self.proposals(pyramid), 0, width=width, height=height)
        owners = boxes.new_zeros(len(boxes), dtype=torch.int64)
        logits, codes = self.score_and_code(pyramid, owners, boxes)
        scores = logits.sigmoid()
        boxes = within(decoded(codes, boxes, weights=BOX_WEIGHTS), width=width, height=height)
        likely = scores > LEAST_SCORE
        scores, boxes = scores[likely], boxes[likely]
        kept = suppressed(boxes, scores, most_overlap=MOST_OVERLAP, most=MOST_CAPS)
        scores, boxes = scores[kept], boxes[kept]
        return SeenCaps(scores, boxes, list(self.mask_logits(pyramid, owners[: len(kept)], boxes)))


def best_proposals(proposals: Proposals, photo: int, *, width: int, height: int) -> Tensor:
    """The likeliest boxes of one photo of the batch, suppressed level by level → (n, 4)."""
    likely, boxes = [], []
    for level in proposals.levels.unique():
        of_level = (proposals.levels == level).nonzero()[:, 0]
        logits = proposals.likely[photo, of_level].detach()
        best, chosen = logits.topk(min(CANDIDATES, len(logits)))
        at = of_level[chosen]
        placed = decoded(proposals.codes[photo, at].detach(), proposals.anchors[at], weights=PROPOSAL_WEIGHTS)
        placed = within(placed, width=width, height=height)
        kept = suppressed(placed, best, most_overlap=MOST_OVERLAP_OF_PROPOSALS, most=PROPOSALS)
        likely.append(best[kept])
        boxes.append(placed[kept])
    order = torch.cat(likely).argsort(descending=True)[:PROPOSALS]
    return torch.cat(boxes)[order]
