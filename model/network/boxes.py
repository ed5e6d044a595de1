"""Boxes around masks, as x, y, width, height."""

from __future__ import annotations

import torch
from torch import Tensor

MARGIN = 0.1
"""Of a window around a mask's box, on every side."""


def boxes_of(masks: Tensor) -> Tensor:
    """(K, h, w) bool, none empty → (K, 4) float, in the masks' cells."""
    columns, rows = masks.any(1).float(), masks.any(2).float()
    left, top = columns.argmax(1), rows.argmax(1)
    right, bottom = masks.shape[2] - columns.flip(1).argmax(1), masks.shape[1] - rows.flip(1).argmax(1)
    return torch.stack([left, top, right - left, bottom - top], dim=1).float()


def with_margin(boxes: Tensor, *, least: float) -> Tensor:
    """(K, 4) boxes widened by the margin, by whole multiples of ``least`` and at least one, on every side."""
    margin = (boxes[:, 2:] * MARGIN / least).ceil().clamp(min=1) * least
    return torch.cat([boxes[:, :2] - margin, boxes[:, 2:] + 2 * margin], dim=1)
