"""Boxes around masks, as x, y, width, height."""

from __future__ import annotations

import torch
from torch import Tensor
from torch.nn import functional as F

MARGIN = 0.1
"""Margin of a window around a mask's box on every side, as a share of the box."""
GAP = 4
"""Empty cells between two parts of a mask beyond which the lesser one does not count to its box."""


def boxes_of(masks: Tensor) -> Tensor:
    """Boxes of K masks (K, h, w) bool, none empty → (K, 4) float, in the masks' cells."""
    columns, rows = masks.any(1).float(), masks.any(2).float()
    left, top = columns.argmax(1), rows.argmax(1)
    right, bottom = masks.shape[2] - columns.flip(1).argmax(1), masks.shape[1] - rows.flip(1).argmax(1)
    return torch.stack([left, top, right - left, bottom - top], dim=1).float()


def main_boxes_of(masks: Tensor) -> Tensor:
    """As ``boxes_of``, without what lies further off than GAP from where most of a mask is.

    Rows and columns are followed from the fullest one outwards until GAP of them in turn are empty.
    """
    left, width = _main_run(masks.sum(1)).unbind(1)
    top, height = _main_run(masks.sum(2)).unbind(1)
    return torch.stack([left, top, width, height], dim=1).float()


def _main_run(counts: Tensor) -> Tensor:
    """(K, n) cells of each row or column → (K, 2) first one and number of the run about the fullest."""
    index = torch.arange(counts.shape[1], device=counts.device)
    peak = counts.argmax(1, keepdim=True)
    held = counts > 0
    near = F.max_pool1d(held.float()[:, None], GAP + 1, stride=1, padding=GAP // 2)[:, 0] > 0
    before = torch.where(~near & (index < peak), index, -1).amax(1, keepdim=True)
    after = torch.where(~near & (index > peak), index, counts.shape[1]).amin(1, keepdim=True)
    inside = held & (index > before) & (index < after)
    first = torch.where(inside, index, counts.shape[1]).amin(1)
    last = torch.where(inside, index, -1).amax(1)
    return torch.stack([first, last - first + 1], dim=1)


def with_margin(boxes: Tensor, *, least: float) -> Tensor:
    """(K, 4) boxes widened by the margin, by whole multiples of ``least`` and at least one, on every side."""
    margin = (boxes[:, 2:] * MARGIN / least).ceil().clamp(min=1) * least
    return torch.cat([boxes[:, :2] - margin, boxes[:, 2:] + 2 * margin], dim=1)
