"""RoIAlign against a plain loop, and against maps whose means are known."""

from __future__ import annotations

import math

import pytest
import torch
from torch import Tensor

from fairyring.model.peers.roi_align import pyramid_align, roi_align


def bilinear(values: Tensor, x: float, y: float) -> float:
    """A map (h, w) at a point in cells, whose middles lie at .5, 1.5, …; it holds on beyond them."""
    height, width = values.shape
    x, y = min(max(x - 0.5, 0), width - 1), min(max(y - 0.5, 0), height - 1)
    left, top = min(int(x), width - 2), min(int(y), height - 2)
    a, b = x - left, y - top
    near = values[top : top + 2, left : left + 2].tolist()
    return (
        near[0][0] * (1 - a) * (1 - b)
        + near[0][1] * a * (1 - b)
        + near[1][0] * (1 - a) * b
        + near[1][1] * a * b
    )


def by_plain_loop(values: Tensor, box: list[float], size: int, stride: float) -> list[list[float]]:
    left, top, right, bottom = (side / stride for side in box)
    cells = []
    for row in range(size):
        cells.append([])
        for column in range(size):
            samples = [
                bilinear(
                    values,
                    left + (column + (i + 0.5) / 2) / size * (right - left),
                    top + (row + (j + 0.5) / 2) / size * (bottom - top),
                )
                for i in range(2)
                for j in range(2)
            ]
            cells[-1].append(sum(samples) / 4)
    return cells


@pytest.mark.parametrize("stride", [1, 8])
def test_every_cell_is_the_mean_of_four_bilinear_samples(stride: int) -> None:
    maps = torch.randn(2, 3, 9, 12, generator=torch.Generator().manual_seed(1))
    boxes = torch.tensor([[1.3, 2.1, 7.7, 6.9], [-2.0, -1.0, 4.5, 3.5], [6.0, 4.0, 14.0, 9.5]]) * stride
    owners = torch.tensor([0, 1, 1])
    found = roi_align(maps, owners, boxes, size=4, stride=stride)
    assert found.shape == (3, 3, 4, 4)
    for nth, owner in enumerate(owners.tolist()):
        for channel in range(3):
            expected = by_plain_loop(maps[owner, channel], boxes[nth].tolist(), 4, stride)
            assert torch.allclose(found[nth, channel], torch.tensor(expected), atol=1e-5)


def test_a_slope_is_read_at_the_middles_of_the_cells_without_rounding() -> None:
    x = (torch.arange(40) + 0.5) * 4
    maps = x.expand(1, 1, 30, 40)
    found = roi_align(maps, torch.tensor([0]), torch.tensor([[10.3, 20.0, 52.3, 62.0]]), size=7, stride=4)
    expected = [10.3 + 42 * (cell + 0.5) / 7 for cell in range(7)]
    assert found[0, 0, 3].tolist() == pytest.approx(expected, abs=1e-3)


@pytest.mark.parametrize(
    ("side", "level"), [(10, 0), (111, 0), (112, 1), (223, 1), (224, 2), (447, 2), (448, 3), (5000, 3)]
)
def test_large_boxes_are_read_from_coarse_levels(side: float, level: int) -> None:
    # Equation 1 of the feature pyramid's paper: 224 px are read from P4, the third of these.
    assert level == min(3, max(0, math.floor(2 + math.log2(side / 224))))
    pyramid = [torch.full((1, 1, 8, 8), float(nth)) for nth in range(4)]
    boxes = torch.tensor([[0.0, 0.0, side, side]])
    assert pyramid_align(pyramid, torch.tensor([0]), boxes, size=2, reduction=1).unique().tolist() == [level]


def test_a_pyramid_of_reduced_photos_counts_sides_in_the_networks_own_pixels() -> None:
    pyramid = [torch.full((1, 1, 8, 8), float(nth)) for nth in range(4)]
    boxes = torch.tensor([[0.0, 0.0, 300.0, 300.0]])
    assert pyramid_align(pyramid, torch.tensor([0]), boxes, size=2, reduction=1).unique().tolist() == [2]
    assert pyramid_align(pyramid, torch.tensor([0]), boxes, size=2, reduction=2).unique().tolist() == [1]
