"""Overlap, codes and suppression of boxes, against plain loops."""

from __future__ import annotations

import pytest
import torch
from torch import Tensor

from fairyring.model.peers.boxes import (
    areas_of,
    coded,
    corners_of,
    decoded,
    overlaps_of,
    quickly_suppressed,
    suppressed,
    within,
)


def some_boxes(count: int, *, seed: int) -> Tensor:
    generator = torch.Generator().manual_seed(seed)
    first = torch.rand(count, 2, generator=generator) * 80
    return torch.cat([first, first + 4 + torch.rand(count, 2, generator=generator) * 40], dim=1)


def overlap(a: list[float], b: list[float]) -> float:
    across = min(a[2], b[2]) - max(a[0], b[0])
    down = min(a[3], b[3]) - max(a[1], b[1])
    shared = max(0.0, across) * max(0.0, down)
    return shared / ((a[2] - a[0]) * (a[3] - a[1]) + (b[2] - b[0]) * (b[3] - b[1]) - shared)


def by_plain_loop(boxes: Tensor, scores: Tensor, most_overlap: float) -> list[int]:
    stay: list[int] = []
    for nth in sorted(range(len(boxes)), key=lambda k: -float(scores[k])):
        if all(overlap(boxes[nth].tolist(), boxes[better].tolist()) <= most_overlap for better in stay):
            stay.append(nth)
    return stay


def test_corners_follow_from_a_corner_and_a_size() -> None:
    assert corners_of(torch.tensor([[3.0, 5.0, 10.0, 20.0]])).tolist() == [[3, 5, 13, 25]]


def test_every_overlap_is_what_a_plain_loop_says() -> None:
    first, second = some_boxes(7, seed=1), some_boxes(5, seed=2)
    expected = torch.tensor([[overlap(a, b) for b in second.tolist()] for a in first.tolist()])
    assert torch.allclose(overlaps_of(first, second), expected, atol=1e-6)


def test_an_empty_box_overlaps_nothing_and_has_no_area() -> None:
    empty = torch.tensor([[5.0, 5.0, 5.0, 9.0]])
    assert areas_of(empty).tolist() == [0]
    assert overlaps_of(empty, torch.tensor([[0.0, 0.0, 10.0, 10.0]])).tolist() == [[0]]


def test_a_code_says_the_shift_in_sizes_and_the_logarithm_of_the_growth() -> None:
    anchor, box = torch.tensor([[0.0, 0.0, 10.0, 20.0]]), torch.tensor([[2.0, 4.0, 22.0, 24.0]])
    # Middles (5, 10) and (12, 14): shifted by .7 widths and .2 heights; twice as wide, as high.
    expected = [0.7, 0.2, 0.6931472, 0]
    assert coded(box, anchor, weights=(1, 1)).tolist()[0] == pytest.approx(expected, abs=1e-6)
    weighted = [7, 2, 5 * 0.6931472, 0]
    assert coded(box, anchor, weights=(10, 5)).tolist()[0] == pytest.approx(weighted, abs=1e-5)


def test_decoding_gives_the_boxes_that_were_coded() -> None:
    boxes, anchors = some_boxes(50, seed=3), some_boxes(50, seed=4)
    codes = coded(boxes, anchors, weights=(10, 5))
    assert torch.allclose(decoded(codes, anchors, weights=(10, 5)), boxes, atol=1e-3)


def test_boxes_are_cut_to_the_photo() -> None:
    boxes = torch.tensor([[-4.0, 3.0, 50.0, 90.0], [70.0, -9.0, 80.0, -2.0]])
    assert within(boxes, width=60, height=40).tolist() == [[0, 3, 50, 40], [60, 0, 60, 0]]


@pytest.mark.parametrize("most_overlap", [0.1, 0.3, 0.5])
def test_suppression_is_what_a_plain_loop_does(most_overlap: float) -> None:
    boxes = some_boxes(60, seed=5)
    scores = torch.rand(60, generator=torch.Generator().manual_seed(6))
    expected = by_plain_loop(boxes, scores, most_overlap)
    assert suppressed(boxes, scores, most_overlap=most_overlap, most=60).tolist() == expected
    assert suppressed(boxes, scores, most_overlap=most_overlap, most=4).tolist() == expected[:4]


def test_fast_suppression_also_hears_boxes_that_have_gone_themselves() -> None:
    # Each overlaps the next by two thirds, the first and the third by a third.
    boxes = torch.tensor([[0.0, 0.0, 10.0, 10.0], [2.0, 0.0, 12.0, 10.0], [4.0, 0.0, 14.0, 10.0]])
    scores = torch.tensor([0.9, 0.8, 0.7])
    assert suppressed(boxes, scores, most_overlap=0.5, most=9).tolist() == [0, 2]
    assert quickly_suppressed(boxes, scores, most_overlap=0.5, most=9).tolist() == [0]


def test_nothing_is_left_of_no_boxes() -> None:
    none, scores = torch.zeros(0, 4), torch.zeros(0)
    assert suppressed(none, scores, most_overlap=0.5, most=9).tolist() == []
    assert quickly_suppressed(none, scores, most_overlap=0.5, most=9).tolist() == []
