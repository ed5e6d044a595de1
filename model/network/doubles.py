"""Masks that hold two caps at once: a kernel between two caps that look alike may draw both."""

from __future__ import annotations

import cv2
import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

LEAST_PART = 0.35
"""A part of less than this share of the largest is no cap of its own."""
LEAST_ROUND = 0.5
"""A part that fills this share of the circle around it is a cap: beside another, less is left of one."""


def parted(logits: Tensor) -> tuple[Tensor, Tensor]:
    """Masks that hold several caps, one by one: (n, h, w) logits → m ≥ n logits, and (m,) whose each is.

    Order is kept. A mask is of several caps if it falls into parts that are round, each for itself: what is
    left of a cap on both sides of another is not.
    """
    found = {nth: caps for nth, mask in enumerate((logits > 0).cpu().numpy()) if (caps := _caps_of(mask))}
    counts = torch.ones(len(logits), dtype=torch.int64, device=logits.device)
    for nth, caps in found.items():
        counts[nth] = len(caps)
    owners = torch.arange(len(logits), device=logits.device).repeat_interleave(counts)
    apart = logits[owners] if found else logits
    for nth, caps in found.items():
        first = int(counts[:nth].sum())
        for place, cap in enumerate(caps, first):
            there = torch.from_numpy(cap).to(logits.device)
            apart[place] = torch.where(there | (logits[nth] <= 0), logits[nth], -logits[nth])
    return apart, owners


def _caps_of(mask: NDArray[np.bool_]) -> list[NDArray[np.bool_]]:
    """The parts (h, w) of a mask that are caps of their own; none where it is of one cap."""
    count, parts, figures, _ = cv2.connectedComponentsWithStats(mask.view(np.uint8), connectivity=4)
    areas = figures[1:, cv2.CC_STAT_AREA]
    large = [nth for nth in range(1, count) if areas[nth - 1] >= LEAST_PART * areas.max()]
    if len(large) < 2:
        return []
    caps = [parts == nth for nth in large]
    return caps if all(_is_round(part) for part in caps) else []


def _is_round(part: NDArray[np.bool_]) -> bool:
    points = cv2.findNonZero(part.view(np.uint8))
    _, radius = cv2.minEnclosingCircle(points)
    # From middle to middle of pixels the circle is half a pixel too small.
    return len(points) >= LEAST_ROUND * np.pi * (radius + 0.5) ** 2
