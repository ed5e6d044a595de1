"""The second look, against closed forms and plain loops."""

from __future__ import annotations

import numpy as np
import pytest
import torch
from msgspec.structs import replace
from torch.distributions import MultivariateNormal

from fairyring.model.network.point_rend import PointMaps
from fairyring.model.network.second_look import (
    LAYERS,
    PARAMETERS,
    SIDE,
    Said,
    SecondLook,
    Windows,
    _points_in,
    _triangle,
    gaussian_loss,
)
from tests.support.small_networks import TINY

CONFIG = replace(TINY, second_look=16)


def look() -> SecondLook:
    torch.manual_seed(3)
    return SecondLook(CONFIG).eval()


def maps(inputs: int = 2) -> PointMaps:
    torch.manual_seed(4)
    return PointMaps(
        fine=torch.randn(inputs, 32, 16, 24),
        semantic=torch.randn(inputs, 32, 4, 6),
        detail=None,
        feature=torch.randn(inputs, 32, 16, 24),
    )


def windows(count: int = 3) -> Windows:
    torch.manual_seed(5)
    return Windows(
        layers=torch.rand(count, LAYERS, SIDE, SIDE),
        places=torch.tensor([[30.0, 20.0, 12.0], [60.0, 40.0, 20.0], [50.0, 30.0, 9.0]])[:count],
        owners=torch.tensor([0, 1, 1])[:count],
        kernels=torch.randn(count, 32),
        scores=torch.tensor([0.9, 0.5, 0.2])[:count],
    )


@torch.inference_mode()
def test_each_cap_is_judged_by_itself() -> None:
    network, all_maps, some = look(), maps(), windows()
    together = network(all_maps, some)
    for nth in range(3):
        alone = network(all_maps, Windows(*(part[nth : nth + 1] for part in some)))
        for one, of_all in zip(alone, together, strict=True):
            torch.testing.assert_close(one[0], of_all[nth])


@torch.inference_mode()
def test_what_lies_in_the_input_far_from_the_window_does_not_matter() -> None:
    network, some = look(), windows(1)
    before = network(maps(), some)
    changed = maps()
    changed.fine[0, :, :, 14:] += 5
    changed.fine[1] += 5
    torch.testing.assert_close(network(changed, some).mean, before.mean)
    changed.fine[0, :, 5, 7] += 5
    assert not torch.allclose(network(changed, some).mean, before.mean)


def test_the_points_of_a_window_are_the_middles_of_its_cells_row_after_row() -> None:
    (points,) = _points_in(torch.tensor([[50.0, 30.0, 8.0]]))
    count = SIDE // 2
    for row in range(count):
        for column in range(count):
            wanted = (42 + (column + 0.5) * 16 / count, 22 + (row + 0.5) * 16 / count)
            assert points[row * count + column].tolist() == pytest.approx(wanted)


def test_the_loss_of_an_ellipse_is_its_normal_density() -> None:
    torch.manual_seed(0)
    root = _triangle(torch.randn(4, 15))
    mean, true = torch.randn(2, 4, PARAMETERS)
    normal = MultivariateNormal(mean, precision_matrix=root @ root.mT)
    constant = PARAMETERS / 2 * float(np.log(2 * np.pi))
    lost = gaussian_loss(Said(torch.zeros(4), mean, root), true)
    torch.testing.assert_close(lost + constant, -normal.log_prob(true), rtol=1e-4, atol=1e-4)


def test_precisions_are_lower_triangles_with_a_diagonal_above_0() -> None:
    root = _triangle(100 * torch.randn(50, 15, generator=torch.Generator().manual_seed(1)))
    assert (root.triu(diagonal=1) == 0).all()
    assert (root.diagonal(dim1=1, dim2=2) > 0).all()
    assert root.diagonal(dim1=1, dim2=2).max() <= np.exp(6) * 1.001


@torch.inference_mode()
def test_calibration_moves_the_quality_and_widens_the_covariance() -> None:
    network = look()
    network.quality_line.copy_(torch.tensor([2.0, -1.0]))
    network.spread.copy_(torch.tensor([2.0, 1.0, 1.0, 1.0, 3.0]))
    root = torch.eye(PARAMETERS).expand(1, -1, -1) * 10
    said = Said(torch.tensor([0.75]), torch.zeros(1, PARAMETERS), root)
    assert network.calibrated_quality(said).item() == pytest.approx(1 / (1 + np.exp(-0.5)))
    (covariance,) = network.calibrated_covariance(said)
    assert covariance.diagonal().tolist() == pytest.approx([0.04, 0.01, 0.01, 0.01, 0.09])


@torch.inference_mode()
def test_few_caps_are_judged_as_all_of_a_bed_are() -> None:
    # A hundred caps have more points to sample than a map has pixels, one has fewer than a large map.
    network, many = look(), windows(1)
    large = PointMaps(
        fine=torch.randn(1, 32, 40, 60),
        semantic=torch.randn(1, 32, 10, 15),
        detail=None,
        feature=torch.randn(1),
    )
    alone = network(large, many)
    crowd = network(large, Windows(*(part.repeat_interleave(100, dim=0) for part in many)))
    for one, of_all in zip(alone, crowd, strict=True):
        assert torch.allclose(one[0], of_all[0], atol=1e-5)
