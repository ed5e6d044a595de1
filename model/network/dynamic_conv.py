"""The dynamic convolution: each cap's own 1×1 kernel over the mask feature of its image."""

from __future__ import annotations

import torch
from torch import Tensor


def mask_logits(feature: Tensor, kernels: Tensor, owners: Tensor) -> Tensor:
    """(B, E, h, w), (K, E), (K,) image of each kernel → (K, h, w): logit = Σ_e kernel_e · feature_e.

    ``owners`` must be in rising order.
    """
    channels, height, width = feature.shape[1:]
    counts = torch.bincount(owners, minlength=len(feature)).tolist()
    pixels = feature.reshape(len(feature), channels, height * width)
    parts = [part @ image for part, image in zip(kernels.split(counts), pixels, strict=True)]
    return torch.cat(parts).reshape(-1, height, width)
