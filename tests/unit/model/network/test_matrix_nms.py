"""Points-NMS and matrix NMS against loops that follow their definitions."""

from __future__ import annotations

import math

import pytest
import torch
from torch import Tensor

from fairyring.model.network.matrix_nms import matrix_nms, points_nms


def iou(first: Tensor, second: Tensor) -> float:
    union = int((first | second).sum())
    return int((first & second).sum()) / union if union else 0.0


def by_loops(masks: Tensor, scores: Tensor, sigma: float) -> list[float]:
    lowered = []
    for j in range(len(masks)):
        factor = 1.0
        for i in range(j):
            covered = max((iou(masks[k], masks[i]) for k in range(i)), default=0.0)
            factor = min(factor, math.exp(-sigma * (iou(masks[i], masks[j]) ** 2 - covered**2)))
        lowered.append(float(scores[j]) * factor)
    return lowered


def by_the_reference(masks: Tensor, scores: Tensor, sigma: float) -> Tensor:
    """As SOLOv2's own code has it: a minimum over whole columns, zeros below the diagonal included."""
    n = len(masks)
    flat = masks.reshape(n, -1).float()
    inter = flat @ flat.T
    sums = flat.sum(1).expand(n, n)
    ious = (inter / (sums + sums.T - inter)).triu(diagonal=1)
    compensate = ious.max(0).values.expand(n, n).T
    decay = torch.exp(-sigma * ious**2) / torch.exp(-sigma * compensate**2)
    return scores * decay.min(0).values


def some_masks(count: int, seed: int) -> Tensor:
    generator = torch.Generator().manual_seed(seed)
    corners = torch.randint(0, 12, (count, 2), generator=generator)
    masks = torch.zeros(count, 20, 20, dtype=torch.bool)
    for mask, (x, y) in zip(masks, corners.tolist(), strict=True):
        mask[y : y + 8, x : x + 8] = True
    return masks


@pytest.mark.parametrize("seed", range(5))
def test_matrix_nms_is_what_loops_and_the_reference_make_of_it(seed: int) -> None:
    masks, scores = some_masks(12, seed), torch.linspace(0.95, 0.2, 12)
    lowered = matrix_nms(masks, scores)
    assert lowered.tolist() == pytest.approx(by_loops(masks, scores, 2.0), rel=1e-5)
    torch.testing.assert_close(lowered, by_the_reference(masks, scores, 2.0))


def test_a_copy_is_lowered_and_what_the_copy_covers_is_not_lowered_by_it_again() -> None:
    one = torch.zeros(6, 6, dtype=torch.bool)
    one[:3] = True
    other = ~one
    lowered = matrix_nms(torch.stack([one, one, other]), torch.tensor([0.9, 0.8, 0.7]))
    assert lowered.tolist() == pytest.approx([0.9, 0.8 * math.exp(-2), 0.7])


def test_one_mask_and_none_come_through() -> None:
    assert matrix_nms(some_masks(1, 0), torch.tensor([0.5])).tolist() == [0.5]
    assert matrix_nms(torch.zeros(0, 4, 4, dtype=torch.bool), torch.zeros(0)).shape == (0,)


@pytest.mark.parametrize("window", [1, 2, 3, 4])
def test_points_nms_keeps_the_largest_of_each_window(window: int) -> None:
    scores = torch.rand(2, 7, 5, generator=torch.Generator().manual_seed(window))
    kept = points_nms(scores, window=window)
    before, after = window // 2, window - 1 - window // 2
    for image in range(2):
        for row in range(7):
            for column in range(5):
                rows = range(max(0, row - before), min(7, row + after + 1))
                columns = range(max(0, column - before), min(5, column + after + 1))
                value = scores[image, row, column]
                largest = max(float(scores[image, r, c]) for r in rows for c in columns)
                assert kept[image, row, column] == (value if value == largest else 0)


def test_points_nms_of_two_is_the_references_pooling() -> None:
    scores = torch.rand(1, 9, 11, generator=torch.Generator().manual_seed(3))
    pooled = torch.nn.functional.max_pool2d(scores, (2, 2), stride=1, padding=1)[:, :-1, :-1]
    torch.testing.assert_close(points_nms(scores, window=2), scores * (pooled == scores))
