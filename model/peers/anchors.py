"""Anchors: boxes of a few sizes and shapes at every place of a feature map, and the caps they learn."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor

from fairyring.model.peers.boxes import overlaps_of

RATIOS = (0.5, 1.0, 2.0)
"""Heights of an anchor over its width."""
NOTHING, NEITHER = -1, -2
"""What an anchor learns: no cap, or nothing at all."""


def anchors_of(
    shapes: Sequence[tuple[int, int]], *, strides: Sequence[int], sizes: Sequence[float], device: torch.device
) -> list[Tensor]:
    """The anchors of each level, (rows · columns · 3, 4) left, top, right, bottom in photo pixels.

    ``shapes``: rows and columns of the levels' maps; ``strides``: photo pixels a cell; ``sizes``: √area.
    A cell's anchors follow each other, and cells go row by row.
    """
    levels = []
    for (rows, columns), stride, size in zip(shapes, strides, sizes, strict=True):
        ratios = torch.tensor(RATIOS, device=device).sqrt()
        half = torch.stack([size / ratios, size * ratios], dim=1) / 2
        y = (torch.arange(rows, device=device) + 0.5) * stride
        x = (torch.arange(columns, device=device) + 0.5) * stride
        middles = torch.stack(torch.meshgrid(y, x, indexing="ij")[::-1], dim=-1).reshape(-1, 1, 2)
        levels.append(torch.cat([middles - half, middles + half], dim=2).reshape(-1, 4))
    return levels


def by_anchor(levels: Sequence[Tensor], each: int) -> Tensor:
    """What each level's map says, (B, 3 · each, rows, columns) → of all anchors in turn (B, n, each)."""
    flat = [level.permute(0, 2, 3, 1).reshape(len(level), -1, each) for level in levels]
    return torch.cat(flat, dim=1)


def learnt_by(
    anchors: Tensor, caps: Tensor, ignored: Tensor, *, cap_from: float, nothing_below: float, each_cap: bool
) -> Tensor:
    """Which cap (k, 4) each anchor (n, 4) learns → (n,) index, NOTHING or NEITHER.

    The cap it overlaps most, from ``cap_from`` on; nothing where that is below ``nothing_below``, and
    neither in between. With ``each_cap`` a cap's best anchors learn it, however little they overlap. Where
    ``ignored`` (H, W) bool is true under an anchor's middle, it does not learn that nothing is there.
    """
    learnt = torch.full((len(anchors),), NOTHING, dtype=torch.int64, device=anchors.device)
    if len(caps):
        overlaps = overlaps_of(anchors, caps)
        best, which = overlaps.max(1)
        learnt[best >= nothing_below] = NEITHER
        learnt = torch.where(best >= cap_from, which, learnt)
        if each_cap:
            nearest = (overlaps == overlaps.amax(0).clamp(min=1e-6)).nonzero()
            learnt[nearest[:, 0]] = nearest[:, 1]
    middles = (anchors[:, :2] + anchors[:, 2:]) / 2
    x = middles[:, 0].long().clamp(0, ignored.shape[1] - 1)
    y = middles[:, 1].long().clamp(0, ignored.shape[0] - 1)
    return torch.where((learnt == NOTHING) & ignored[y, x], NEITHER, learnt)


def sampled(learnt: Tensor, *, count: int, most_caps: float) -> tuple[Tensor, Tensor]:
    """So many of those that learn a cap or nothing, at random → their indices: caps', nothings'.

    ``most_caps``: largest share of those that learn a cap.
    """
    caps, nothings = (learnt >= 0).nonzero()[:, 0], (learnt == NOTHING).nonzero()[:, 0]
    caps = _some(caps, round(count * most_caps))
    return caps, _some(nothings, count - len(caps))


def _some(indices: Tensor, count: int) -> Tensor:
    return indices[torch.randperm(len(indices), device=indices.device)[:count]]
