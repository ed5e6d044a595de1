"""Folded batch norms change nothing but the number of modules."""

from __future__ import annotations

import copy

import pytest
import torch
from torch import nn

from fairyring.model.network.backbone import build_backbone
from fairyring.model.network.config import Backbone
from fairyring.model.network.fold import fold_batch_norms


def unsettle(module: nn.Module) -> None:
    """Gives every batch norm statistics and weights of its own."""
    for part in module.modules():
        if isinstance(part, nn.BatchNorm2d):
            assert part.running_mean is not None
            assert part.running_var is not None
            part.running_mean.normal_(std=0.2)
            part.running_var.uniform_(0.5, 2)
            nn.init.uniform_(part.weight, 0.5, 1.5)
            nn.init.normal_(part.bias, std=0.2)


@pytest.mark.parametrize("name", ["lite0", "r18", "r50"])
@torch.no_grad()
def test_folding_leaves_the_outputs_as_they_are(name: Backbone) -> None:
    torch.manual_seed(1)
    plain = build_backbone(name).eval()
    unsettle(plain)
    folded = copy.deepcopy(plain)
    fold_batch_norms(folded)
    assert not any(isinstance(part, nn.BatchNorm2d) for part in folded.modules())
    x = torch.randn(1, 3, 64, 64)
    for before, after in zip(plain(x), folded(x), strict=True):
        scale = before.abs().max().item()
        torch.testing.assert_close(after, before, atol=1e-4 * scale, rtol=1e-3)


@torch.no_grad()
def test_a_bias_is_kept_and_a_norm_without_a_convolution_stays() -> None:
    module = nn.Sequential(nn.BatchNorm2d(3), nn.Conv2d(3, 4, 1), nn.BatchNorm2d(4), nn.ReLU()).eval()
    unsettle(module)
    x = torch.randn(2, 3, 4, 4)
    expected = module(x)
    fold_batch_norms(module)
    assert isinstance(module[0], nn.BatchNorm2d)
    assert isinstance(module[2], nn.Identity)
    torch.testing.assert_close(module(x), expected)
    fold_batch_norms(module)
    torch.testing.assert_close(module(x), expected)
