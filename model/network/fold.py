"""Batch norms folded into the convolutions before them: the same figures with fewer passes over memory."""

from __future__ import annotations

from typing import cast

import torch
from torch import nn
from torch.nn.utils.fusion import fuse_conv_bn_weights


def fold_batch_norms(module: nn.Module) -> None:
    """Folds, in place, every batch norm registered right after a convolution. For evaluation alone."""
    before: nn.Module | None = None
    for name, child in list(module.named_children()):
        if isinstance(child, nn.BatchNorm2d) and isinstance(before, nn.Conv2d):
            mean, var = cast("torch.Tensor", child.running_mean), cast("torch.Tensor", child.running_var)
            before.weight, before.bias = fuse_conv_bn_weights(
                before.weight, before.bias, mean, var, child.eps, child.weight, child.bias
            )
            setattr(module, name, nn.Identity())
        else:
            fold_batch_norms(child)
        before = child
