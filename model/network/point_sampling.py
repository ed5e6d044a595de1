"""Values of feature maps at points between their pixels, and the choice of points that need a second look."""

from __future__ import annotations

import torch
from torch import Tensor
from torch.nn import functional as F

OVERSAMPLING = 3
UNCERTAIN_SHARE = 0.75


def sample_maps(maps: Tensor, owners: Tensor, points: Tensor, *, stride: float) -> Tensor:
    """Bilinear samples: (M, C, h, w), (P,) map of each point, (P, 2) x, y in photo pixels → (P, C).

    A map's pixel (i, j) has its middle at ((j + 0.5) · stride, (i + 0.5) · stride); beyond the outermost
    middles their values hold on.
    """
    count, channels, height, width = maps.shape
    rows = maps.permute(0, 2, 3, 1).reshape(count * height * width, channels)
    x = (points[:, 0] / stride - 0.5).clamp(0, width - 1)
    y = (points[:, 1] / stride - 0.5).clamp(0, height - 1)
    left, top = x.floor().clamp(max=max(width - 2, 0)), y.floor().clamp(max=max(height - 2, 0))
    across, down = x - left, y - top
    first = (owners * height + top.long()) * width + left.long()
    right, below = min(1, width - 1), width * min(1, height - 1)
    corners = torch.stack([first, first + right, first + below, first + below + right], dim=1)
    weights = torch.stack(
        [(1 - across) * (1 - down), across * (1 - down), (1 - across) * down, across * down], dim=1
    )
    # One pass over the rows, where sums of gathered corners would take seven.
    rows = rows if rows.is_floating_point() else rows.float()
    return F.embedding_bag(corners, rows, per_sample_weights=weights.to(rows.dtype), mode="sum")


def training_points(coarse: Tensor, boxes: Tensor, *, count: int, stride: float) -> Tensor:
    """Points to train on, in each cap's box: (K, h, w) coarse logits, (K, 4) x, y, width, height → (K,
    count, 2).

    PointRend (Kirillov et al., CVPR 2020): three times as many are sampled evenly, 75 % of the points are
    those of them with the logit nearest 0, the rest are sampled evenly.
    """
    caps = len(boxes)
    sampled = torch.rand(caps, OVERSAMPLING * count, 2, device=coarse.device)
    sampled = boxes[:, None, :2] + sampled * boxes[:, None, 2:]
    owners = torch.arange(caps, device=coarse.device).repeat_interleave(sampled.shape[1])
    logits = sample_maps(coarse[:, None], owners, sampled.reshape(-1, 2), stride=stride)
    uncertain = int(UNCERTAIN_SHARE * count)
    order = logits.reshape(caps, -1).abs().topk(uncertain, dim=1, largest=False).indices
    chosen = sampled.gather(1, order[..., None].expand(-1, -1, 2))
    rest = torch.rand(caps, count - uncertain, 2, device=coarse.device)
    return torch.cat([chosen, boxes[:, None, :2] + rest * boxes[:, None, 2:]], dim=1)
