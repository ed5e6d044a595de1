"""The loss of YOLACT: categories with the hardest negatives, boxes, masks in their boxes, caps anywhere."""

from __future__ import annotations

import torch
from torch import Tensor
from torch.nn import functional as F

from fairyring.model.network.objective import Batch
from fairyring.model.peers.anchors import NOTHING, learnt_by
from fairyring.model.peers.boxes import areas_of, coded
from fairyring.model.peers.true_caps import TrueCaps, true_caps
from fairyring.model.peers.yolact import WEIGHTS, YOLACT, Predicted, mixed

HARDEST = 3
"""Anchors that learn that nothing is there, for each that learns a cap: those that are surest of one."""
BOX_WEIGHT, MASK_WEIGHT = 1.5, 6.125
MOST_MASKS = 100
"""Most masks of a photo that are learnt at a time."""


def losses_of(network: YOLACT, batch: Batch) -> dict[str, Tensor]:
    """The terms of the loss by name, scalars to be added up (sections 3 and 6 of the paper)."""
    predicted, truth = network(batch.photos), true_caps(batch)
    terms = [_losses(predicted, true, stride=network.mask_stride) for true in truth]
    found = max(1, sum(count for _, count in terms))
    losses = {name: torch.stack([each[name] for each, _ in terms]).sum() / found for name in terms[0][0]}
    return losses | {"anywhere": _anywhere(predicted, truth, stride=2 * network.mask_stride)}


def _losses(predicted: Predicted, true: TrueCaps, *, stride: int) -> tuple[dict[str, Tensor], int]:
    """Sums over the anchors of one photo that learn a cap, and how many those are."""
    anchors = predicted.anchors
    learnt = learnt_by(anchors, true.boxes, true.ignored, cap_from=0.5, nothing_below=0.4, each_cap=True)
    holding = (learnt >= 0).nonzero()[:, 0]
    caps = learnt[holding]
    codes = coded(true.boxes[caps], anchors[holding], weights=WEIGHTS)
    placed = F.smooth_l1_loss(predicted.codes[true.nth, holding], codes, reduction="sum")
    return {
        "cap": _category(predicted.likely[true.nth], learnt),
        "box": BOX_WEIGHT * placed,
        "mask": MASK_WEIGHT * _masks(predicted, true, holding, caps, stride=stride),
    }, len(holding)


def _category(likely: Tensor, learnt: Tensor) -> Tensor:
    """Cross-entropy of the anchors (n, 2) that learn a cap, and of the HARDEST times as many others."""
    held, nothings = learnt >= 0, (learnt == NOTHING).nonzero()[:, 0]
    each = F.cross_entropy(likely, held.long(), reduction="none")
    hardest = min(len(nothings), HARDEST * max(1, int(held.sum())))
    return each[held].sum() + each[nothings].topk(hardest).values.sum()


def _masks(predicted: Predicted, true: TrueCaps, holding: Tensor, caps: Tensor, *, stride: int) -> Tensor:
    """Mean cross-entropy of each mask within its true box, summed over the anchors ``holding`` ``caps``."""
    if not len(holding):
        return predicted.prototypes.sum() * 0
    some = torch.randperm(len(holding), device=holding.device)[:MOST_MASKS]
    caps = caps[some]
    logits = mixed(predicted.prototypes[true.nth], predicted.mixtures[true.nth, holding[some]])
    truly = (F.avg_pool2d(true.masks[:, None].float(), stride)[:, 0] >= 0.5).float()[caps]
    each = F.binary_cross_entropy_with_logits(logits, truly, reduction="none")
    boxes = true.boxes[caps]
    inside = _cells_in(boxes, shape=(logits.shape[-2], logits.shape[-1]), stride=stride)
    means = (each * inside).flatten(1).sum(1) / (areas_of(boxes) / stride**2)
    return means.sum() * (len(holding) / len(some))


def _cells_in(boxes: Tensor, *, shape: tuple[int, int], stride: int) -> Tensor:
    """(n, h, w) bool: the cells whose middles lie in each box."""
    y = (torch.arange(shape[0], device=boxes.device) + 0.5) * stride
    x = (torch.arange(shape[1], device=boxes.device) + 0.5) * stride
    across = (x >= boxes[:, None, 0]) & (x < boxes[:, None, 2])
    down = (y >= boxes[:, None, 1]) & (y < boxes[:, None, 3])
    return down[:, :, None] & across[:, None, :]


def _anywhere(predicted: Predicted, truth: list[TrueCaps], *, stride: int) -> Tensor:
    """Cross-entropy of P3's cells against whether any cap is there; what is ignored counts not."""
    covered = [
        true.masks.amax(0) if len(true.masks) else torch.zeros_like(true.ignored, dtype=torch.uint8)
        for true in truth
    ]
    caps = F.avg_pool2d(torch.stack(covered)[:, None].float(), stride)[:, 0] >= 0.5
    ignored = torch.stack([true.ignored for true in truth])
    counts = F.avg_pool2d(ignored[:, None].float(), stride)[:, 0] == 0
    each = F.binary_cross_entropy_with_logits(predicted.anywhere, caps.float(), reduction="none")
    return (each * counts).sum() / counts.sum().clamp(min=1)
