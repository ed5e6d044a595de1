"""The caps that a peer sees in a photo, and their outlines."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor
from torch.nn import functional as F

from fairyring.model.geometry.raster import rle_of_outline
from fairyring.model.predict.level_lines import outline_of_logits
from fairyring.model.predict.seen import Detection


class SeenCaps(NamedTuple):
    """n caps of one photo, best first."""

    scores: Tensor
    """(n,)."""
    boxes: Tensor
    """(n, 4): left, top, right, bottom, photo pixels."""
    logits: list[Tensor]
    """Of each a grid (h, w) that fills its box; above 0 is cap."""


def detections_of(seen: SeenCaps, *, width: int, height: int) -> list[Detection]:
    """The caps with outlines at the photo's pixels; those without a pixel are left out."""
    found = []
    for score, box, logits in zip(seen.scores.tolist(), seen.boxes, seen.logits, strict=True):
        corner, window = window_of(logits, box.cpu(), width=width, height=height)
        outline = outline_of_logits(window, corner=corner) if window.size else []
        if outline:
            rle = rle_of_outline(outline, width=width, height=height)
            found.append(Detection(score=score, outline=outline, rle=rle))
    return found


def window_of(logits: Tensor, box: Tensor, *, width: int, height: int) -> tuple[tuple[int, int], np.ndarray]:
    """The logits at the pixels of a photo whose middles lie in the box → first column and row, (h, w).

    Bilinear between the middles of the grid's cells, whose outermost values hold on to the box's edge.
    """
    left, top, right, bottom = box.tolist()
    first = max(0, int(np.ceil(left - 0.5))), max(0, int(np.ceil(top - 0.5)))
    columns = np.arange(first[0], min(width, int(np.floor(right - 0.5)) + 1)) + 0.5
    rows = np.arange(first[1], min(height, int(np.floor(bottom - 0.5)) + 1)) + 0.5
    if not len(columns) or not len(rows):
        return first, np.zeros((0, 0), np.float32)
    x = 2 * (columns - left) / max(right - left, 1e-6) - 1
    y = 2 * (rows - top) / max(bottom - top, 1e-6) - 1
    grid = torch.from_numpy(np.stack(np.meshgrid(x, y), axis=-1)).to(logits)[None]
    sampled = F.grid_sample(logits[None, None], grid, padding_mode="border", align_corners=False)
    return first, sampled[0, 0].float().cpu().numpy()
