"""Non-maximum suppression without loops: points-NMS and matrix NMS (SOLOv2, Wang et al., NeurIPS 2020)."""

from __future__ import annotations

import torch
from torch import Tensor
from torch.nn import functional as F

SIGMA = 2.0


def points_nms(scores: Tensor, *, window: int) -> Tensor:
    """(B, rows, columns) with every cell zeroed that is not the largest of its window.

    Of window 2: of itself and the cells to the left, above, and above left, as the reference pools. 1 keeps
    all.
    """
    before = window // 2
    padded = F.pad(scores[:, None], (before, window - 1 - before, before, window - 1 - before), value=-1.0)
    largest = F.max_pool2d(padded, window, stride=1)[:, 0]
    return scores * (scores == largest)


def matrix_nms(masks: Tensor, scores: Tensor, *, sigma: float = SIGMA) -> Tensor:
    """Scores lowered by how much each mask is covered by better ones.

    ``masks`` (n, h, w) bool and ``scores`` (n,) in falling order, one category → (n,). With iou_ij of mask
    j and a better i, and c_i the largest IoU of i with one still better: score_j · min_i exp(-σ (iou_ij² -
    c_i²)).
    """
    if not len(scores):
        return scores
    flat = masks.flatten(1).float()
    overlap = flat @ flat.T
    area = flat.sum(1)
    iou = (overlap / (area[:, None] + area[None] - overlap).clamp(min=1e-6)).triu(diagonal=1)
    covered = iou.amax(dim=0)
    decay = torch.exp(-sigma * (iou**2 - covered[:, None] ** 2))
    # Below the diagonal iou is 0: such pairs must not decide.
    better = torch.ones_like(iou, dtype=torch.bool).triu(diagonal=1)
    return scores * torch.where(better, decay, 1.0).amin(dim=0)
