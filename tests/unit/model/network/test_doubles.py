"""Masks that hold two caps at once."""

from __future__ import annotations

import torch
from torch import Tensor

from fairyring.model.network.doubles import parted

SIDE = 40
SURE = 5.0


def drawn(*discs: tuple[int, int, int]) -> Tensor:
    """(SIDE, SIDE) logits, above 0 in discs of column, row and radius."""
    rows, columns = torch.meshgrid(torch.arange(SIDE), torch.arange(SIDE), indexing="ij")
    logits = torch.full((SIDE, SIDE), -SURE)
    for x, y, radius in discs:
        logits[(columns - x) ** 2 + (rows - y) ** 2 < radius**2] = SURE
    return logits


LEFT, RIGHT = (10, 20, 7), (28, 20, 7)


def test_a_mask_of_two_caps_becomes_two_of_the_same_owner() -> None:
    logits, owners = parted(torch.stack([drawn((20, 20, 9)), drawn(LEFT, RIGHT)]))
    assert owners.tolist() == [0, 1, 1]
    torch.testing.assert_close(logits, torch.stack([drawn((20, 20, 9)), drawn(LEFT), drawn(RIGHT)]))


def test_three_caps_become_three() -> None:
    three = (LEFT, RIGHT, (20, 5, 5))
    logits, owners = parted(drawn(*three)[None])
    assert owners.tolist() == [0, 0, 0]
    assert sorted((logits > 0).flatten(1).sum(1).tolist()) == sorted(
        int((drawn(disc) > 0).sum()) for disc in three
    )


def test_what_others_leave_of_a_cap_on_both_sides_stays_one_cap() -> None:
    cut_in_two = drawn((20, 20, 12))
    cut_in_two[:, 17:24] = -SURE
    logits, owners = parted(cut_in_two[None])
    assert owners.tolist() == [0]
    torch.testing.assert_close(logits[0], cut_in_two)


def test_a_speck_beside_a_cap_makes_no_second_one() -> None:
    logits, owners = parted(drawn(LEFT, (28, 20, 2))[None])
    assert owners.tolist() == [0]
    torch.testing.assert_close(logits[0], drawn(LEFT, (28, 20, 2)))


def test_empty_masks_and_none_at_all_are_let_through() -> None:
    assert parted(torch.full((1, SIDE, SIDE), -SURE))[1].tolist() == [0]
    logits, owners = parted(torch.zeros(0, SIDE, SIDE))
    assert (tuple(logits.shape), owners.tolist()) == ((0, SIDE, SIDE), [])
