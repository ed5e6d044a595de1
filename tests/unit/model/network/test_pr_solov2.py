"""The whole network: the shapes of what it says, in every size and with either reading of PointRend."""

from __future__ import annotations

import math

import pytest
import torch

from fairyring.model.network.config import SIZES
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.network.targets import grid_shape
from tests.support.small_networks import tiny


@pytest.mark.parametrize("name", SIZES)
@torch.inference_mode()
def test_every_size_gives_outputs_of_the_promised_shapes(name: str) -> None:
    torch.manual_seed(0)
    config = SIZES[name]
    network = PRSOLOv2(config).eval()
    height, width = 2 * config.multiple, 3 * config.multiple
    photos = torch.randint(0, 256, (2, 3, height, width), dtype=torch.uint8)
    outputs = network(photos, torch.zeros(2, 2))
    for level in range(5):
        rows, columns = grid_shape(config, level, height=height, width=width)
        assert outputs.categories[level].shape == (2, rows, columns)
        assert outputs.kernels[level].shape == (2, config.kernel_channels, rows, columns)
    cells = (height // config.mask_stride, width // config.mask_stride)
    assert outputs.feature.shape == (2, config.kernel_channels, *cells)
    assert outputs.sharp is None
    maps = outputs.point_maps
    assert maps is not None
    assert maps.fine.shape == (2, config.point_channels, *cells)
    assert maps.semantic.shape == (2, config.point_channels, cells[0] // 4, cells[1] // 4)
    if config.detail_channels:
        assert maps.detail is not None
        assert maps.detail.shape == (2, config.detail_channels, height // 2, width // 2)
    else:
        assert maps.detail is None
    scores = torch.cat([level.flatten() for level in outputs.categories]).sigmoid()
    assert float(scores.mean()) == pytest.approx(0.01, abs=0.003)


@torch.inference_mode()
def test_the_smallest_input_of_all_is_read() -> None:
    outputs = tiny().eval()(torch.zeros(1, 3, 32, 32, dtype=torch.uint8), torch.zeros(1, 2))
    assert [tuple(level.shape) for level in outputs.categories] == [
        (1, 2, 2),
        (1, 2, 2),
        (1, 1, 1),
        (1, 1, 1),
        (1, 1, 1),
    ]


@torch.inference_mode()
def test_reading_b_sharpens_the_mask_feature_to_the_same_size() -> None:
    network = tiny(point_rend="semantic").eval()
    outputs = network(torch.zeros(2, 3, 64, 96, dtype=torch.uint8), torch.zeros(2, 2))
    assert outputs.feature.shape == (2, 32, 16, 24)
    assert outputs.point_maps is None
    assert outputs.sharp is not None
    assert outputs.sharp.feature is outputs.feature
    # 8 × 12 pixels in the first step, all of 16 × 24 in the second.
    assert outputs.sharp.points.shape == (2, 8 * 12 + 16 * 24, 2)
    assert outputs.sharp.logits.shape == (2, 8 * 12 + 16 * 24)
    first = outputs.sharp.points[0, : 8 * 12]
    assert {tuple(point) for point in first.tolist()} == {
        (8 * x + 4, 8 * y + 4) for x in range(12) for y in range(8)
    }


@torch.inference_mode()
def test_without_point_rend_there_is_nothing_for_points() -> None:
    outputs = tiny(point_rend="off").eval()(torch.zeros(1, 3, 64, 64, dtype=torch.uint8), torch.zeros(1, 2))
    assert outputs.point_maps is None
    assert outputs.sharp is None


@torch.inference_mode()
def test_inputs_of_a_batch_do_not_touch_each_other() -> None:
    network = tiny().eval()
    photos = torch.randint(0, 256, (2, 3, 64, 64), dtype=torch.uint8)
    origins = torch.tensor([[-32.0, -32], [100, 7]])
    together = network(photos, origins)
    alone = network(photos[1:], origins[1:])
    torch.testing.assert_close(together.feature[1:], alone.feature, atol=1e-5, rtol=1e-4)
    for level in range(5):
        torch.testing.assert_close(together.kernels[level][1:], alone.kernels[level], atol=1e-5, rtol=1e-4)


def test_kernels_know_where_in_the_photo_they_are_and_scores_do_not() -> None:
    network = tiny().eval()
    photos = torch.randint(0, 256, (1, 3, 64, 64), dtype=torch.uint8)
    with torch.inference_mode():
        here, there = (network(photos, torch.tensor([[x, 0.0]])) for x in (-600.0, 500.0))
    assert not torch.allclose(here.kernels[0], there.kernels[0], rtol=1e-3)
    torch.testing.assert_close(here.categories[0], there.categories[0])


def test_heads_start_as_the_reference_starts_them() -> None:
    network = tiny(head_channels=64)
    assert network.category_head.logit.bias is not None
    assert network.category_head.logit.bias.item() == pytest.approx(-math.log(99))
    assert network.kernel_head.weights.weight.std().item() == pytest.approx(0.01, rel=0.05)
    assert network.kernel_head.weights.bias is not None
    assert network.kernel_head.weights.bias.eq(0).all()
