"""Where a kernel's word counts."""

from __future__ import annotations

import pytest
import torch

from fairyring.model.network.config import NetworkConfig
from fairyring.model.network.reach import FAR, middles_of, reach_of, within_reach


def test_each_level_reaches_two_thirds_of_its_largest_cap_in_photo_pixels() -> None:
    config = NetworkConfig(reduction=2, scale_ranges=((1, 30), (15, 60), (30, 120), (60, 240), (120, 480)))
    assert [reach_of(config, level) for level in range(3)] == pytest.approx([40, 80, 160])


def test_middles_are_shares_of_the_inputs_sides() -> None:
    held = torch.zeros(4, 8, dtype=torch.bool)
    held[0, 7] = held[3, 0] = True
    assert middles_of(held).tolist() == [[0.9375, 0.125], [0.0625, 0.875]]


def test_pixels_within_reach_keep_their_logits_and_pass_gradients_alone() -> None:
    logits = torch.randn(2, 6, 10, requires_grad=True)
    middles = torch.tensor([[0.5, 0.5], [0.05, 0.05]])
    seen = within_reach(logits, middles, torch.tensor([1.25, 2.0]))
    near = torch.zeros(2, 6, 10, dtype=torch.bool)
    near[0, 2:4, 4:6] = True  # about x = 5, y = 3, and middles lie at halves
    near[1, :2, :3] = True  # about x = 0.5, y = 0.3
    assert torch.equal(seen[near], logits[near])
    assert (seen[~near] == FAR).all()
    seen.sum().backward()
    assert torch.equal(logits.grad != 0, near)


def test_a_wider_photo_does_not_change_what_is_near() -> None:
    logits = torch.randn(1, 8, 40)
    narrow = within_reach(logits[:, :, :20], torch.tensor([[0.5, 0.5]]), torch.tensor([4.0]))
    wide = within_reach(logits, torch.tensor([[0.25, 0.5]]), torch.tensor([4.0]))
    assert torch.equal(wide[:, :, :20], narrow)
    assert (wide[:, :, 20:] == FAR).all()
