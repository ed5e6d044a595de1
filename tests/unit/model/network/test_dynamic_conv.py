"""The dynamic convolution against einsum."""

from __future__ import annotations

import torch

from fairyring.model.network.dynamic_conv import mask_logits


def test_every_kernel_is_laid_on_its_own_image() -> None:
    generator = torch.Generator().manual_seed(0)
    feature = torch.randn(4, 8, 5, 7, generator=generator)
    kernels = torch.randn(6, 8, generator=generator)
    owners = torch.tensor([0, 0, 0, 2, 3, 3])
    expected = torch.einsum("ke,kehw->khw", kernels, feature[owners])
    torch.testing.assert_close(mask_logits(feature, kernels, owners), expected)


def test_channels_last_features_and_no_kernels_are_fine() -> None:
    feature = torch.randn(2, 8, 5, 7).contiguous(memory_format=torch.channels_last)
    kernels, owners = torch.randn(1, 8), torch.tensor([1])
    expected = torch.einsum("ke,kehw->khw", kernels, feature[owners])
    torch.testing.assert_close(mask_logits(feature, kernels, owners), expected)
    none = mask_logits(feature, torch.zeros(0, 8), torch.zeros(0, dtype=torch.int64))
    assert none.shape == (0, 5, 7)
