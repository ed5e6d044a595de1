"""Boxes around masks, and the margin around those."""

from __future__ import annotations

import torch

from fairyring.model.network.boxes import boxes_of, with_margin


def test_boxes_enclose_their_masks() -> None:
    masks = torch.zeros(4, 6, 9, dtype=torch.bool)
    masks[0, 2, 3] = True
    masks[1, 0, 0] = masks[1, 5, 8] = True
    masks[2, 1:4, 2:7] = True
    masks[2, 2, 4] = False
    masks[3, :, 8] = True
    assert boxes_of(masks).tolist() == [[3, 2, 1, 1], [0, 0, 9, 6], [2, 1, 5, 3], [8, 0, 1, 6]]
    assert boxes_of(masks[:0]).shape == (0, 4)


def test_a_margin_is_a_tenth_in_whole_steps_and_at_least_one() -> None:
    boxes = torch.tensor([[10.0, 20, 5, 25], [0, 0, 40, 10]])
    assert with_margin(boxes, least=1).tolist() == [[9, 17, 7, 31], [-4, -1, 48, 12]]
    boxes = torch.tensor([[80.0, 160, 40, 200]])
    assert with_margin(boxes, least=8).tolist() == [[72, 136, 56, 248]]
