"""Sampling between pixels against PyTorch's own, and which points are trained on."""

from __future__ import annotations

import pytest
import torch
from torch import Tensor
from torch.nn import functional as F

from fairyring.model.network.point_sampling import sample_maps, training_points


def by_grid_sample(maps: Tensor, owners: Tensor, points: Tensor, stride: float) -> Tensor:
    height, width = maps.shape[-2:]
    grid = points / torch.tensor([width * stride, height * stride]) * 2 - 1
    sampled = [
        F.grid_sample(
            maps[owner : owner + 1],
            place.view(1, 1, 1, 2),
            mode="bilinear",
            padding_mode="border",
            align_corners=False,
        ).flatten()
        for owner, place in zip(owners.tolist(), grid, strict=True)
    ]
    return torch.stack(sampled)


@pytest.mark.parametrize("shape", [(5, 7), (1, 1), (1, 6), (4, 1), (2, 2)])
@pytest.mark.parametrize("stride", [1, 4])
def test_maps_are_sampled_as_pytorch_samples_them(shape: tuple[int, int], stride: int) -> None:
    generator = torch.Generator().manual_seed(1)
    maps = torch.randn(3, 2, *shape, generator=generator)
    extent = torch.tensor([shape[1], shape[0]]) * stride
    inside = torch.rand(40, 2, generator=generator) * extent
    corners = torch.tensor([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]) * extent
    outside = torch.tensor([[-3.0, 0.5], [2.0, 1.5], [0.4, 7.0]]) * extent
    points = torch.cat([inside, corners, outside])
    owners = torch.randint(0, 3, (len(points),), generator=generator)
    expected = by_grid_sample(maps, owners, points, stride)
    torch.testing.assert_close(sample_maps(maps, owners, points, stride=stride), expected)


def test_the_middle_of_a_pixel_has_its_value_also_of_bytes() -> None:
    masks = torch.randint(0, 2, (2, 1, 6, 5), dtype=torch.uint8, generator=torch.Generator().manual_seed(2))
    rows, columns = torch.meshgrid(torch.arange(6), torch.arange(5), indexing="ij")
    points = torch.stack([columns, rows], -1).reshape(-1, 2) + 0.5
    values = sample_maps(masks, torch.ones(30, dtype=torch.int64), points, stride=1)
    assert values[:, 0].tolist() == masks[1, 0].flatten().tolist()
    between = sample_maps(
        torch.tensor([[[[0, 1]]]], dtype=torch.uint8), torch.tensor([0]), torch.ones(1, 2), stride=1
    )
    assert between.tolist() == [[0.5]]


def test_no_points_are_no_values() -> None:
    empty = sample_maps(
        torch.zeros(1, 3, 4, 4), torch.zeros(0, dtype=torch.int64), torch.zeros(0, 2), stride=4
    )
    assert empty.shape == (0, 3)


def test_three_quarters_of_the_points_are_the_least_certain_of_three_times_as_many() -> None:
    torch.manual_seed(0)
    # The logit is 0 along x = 50.
    ramp = (torch.arange(100) + 0.5 - 50).expand(1, 100, 100)
    boxes = torch.tensor([[0.0, 0.0, 100.0, 100.0]])
    points = training_points(ramp, boxes, count=400, stride=1)
    assert points.shape == (1, 400, 2)
    away = (points[0, :, 0] - 50).abs()
    # 300 of 1200 even draws lie in the quarter about the middle, give or take the luck of the draw.
    assert away[:300].max() < 12.5 * 1.2
    assert away[:300].max() > 12.5 * 0.8
    # Even draws are 25 from the middle in the mean, with a standard error of 1.4.
    assert away[300:].mean() == pytest.approx(25, abs=6)


def test_training_points_lie_in_their_caps_boxes() -> None:
    torch.manual_seed(0)
    boxes = torch.tensor([[10.0, 20.0, 5.0, 9.0], [40.0, 3.0, 20.0, 1.0]])
    points = training_points(torch.randn(2, 16, 16), boxes, count=196, stride=4)
    assert points.shape == (2, 196, 2)
    for box, of_cap in zip(boxes, points, strict=True):
        assert (of_cap >= box[:2]).all()
        assert (of_cap <= box[:2] + box[2:]).all()
    whole = points[0].frac().eq(0).all(dim=1)
    assert not whole.any()
