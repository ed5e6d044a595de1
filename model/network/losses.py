"""Eq. 1–3 of the paper: focal loss for categories, dice loss for masks; and the loss of the points."""

from __future__ import annotations

import torch
from torch import Tensor
from torch.nn import functional as F

ALPHA, GAMMA = 0.25, 2.0
DICE_WEIGHT = 3.0
"""λ of Eq. 1."""


def focal_loss(logits: Tensor, positive: Tensor) -> Tensor:
    """Eq. 2, summed over cells. ``logits`` (n,), ``positive`` (n,) bool → a scalar.

    -α_t (1 - p_t)^γ log p_t with p_t the probability of what is true (Lin et al., ICCV 2017).
    """
    target = positive.to(logits.dtype)
    cross_entropy = F.binary_cross_entropy_with_logits(logits, target, reduction="none")
    p = logits.sigmoid()
    p_true = torch.where(positive, p, 1 - p)
    alpha = torch.where(positive, ALPHA, 1 - ALPHA)
    return (alpha * (1 - p_true) ** GAMMA * cross_entropy).sum()


def dice_loss(logits: Tensor, targets: Tensor) -> Tensor:
    """Eq. 3 of each mask: 1 - 2 Σpq / (Σp² + Σq²). Logits and targets (n, h, w) → (n,), float32."""
    p = logits.flatten(1).float().sigmoid()
    q = targets.flatten(1).float()
    overlap = (p * q).sum(1)
    return 1 - 2 * overlap / ((p * p).sum(1) + (q * q).sum(1)).clamp(min=1e-4)


def point_loss(logits: Tensor, targets: Tensor) -> Tensor:
    """Mean binary cross-entropy against soft labels, (n,) and (n,) → a scalar; 0 without points."""
    if not len(logits):
        return logits.sum()
    return F.binary_cross_entropy_with_logits(logits.float(), targets.float())
