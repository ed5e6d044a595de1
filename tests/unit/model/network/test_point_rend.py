"""The point head against one plain perceptron over everything a point sees."""

from __future__ import annotations

import pytest
import torch
from torch import Tensor
from torch.nn import functional as F

from fairyring.model.network.point_rend import Detail, PointHead, Queries
from fairyring.model.network.point_sampling import sample_maps
from tests.support.small_networks import TINY, tiny


def sampled(maps: Tensor, queries: Queries, stride: int) -> Tensor:
    """(P, C) by PyTorch's own sampling."""
    extent = torch.tensor([maps.shape[-1], maps.shape[-2]]) * stride
    grid = (queries.points / extent * 2 - 1).view(-1, 1, 1, 2)
    return F.grid_sample(maps[queries.owners], grid, padding_mode="border", align_corners=False)[:, :, 0, 0]


@pytest.mark.parametrize("detail", [0, 4])
@pytest.mark.parametrize("reduction", [1, 2])
def test_layers_run_once_an_image_are_one_linear_layer_of_all_that_a_point_sees(
    detail: int, reduction: int
) -> None:
    network = tiny(detail_channels=detail, reduction=reduction)
    head = network.point_head
    assert head is not None
    torch.manual_seed(1)
    p2, p4 = torch.randn(2, 32, 16, 24), torch.randn(2, 32, 4, 6)
    photos = torch.randn(2, 3, 64 * reduction, 96 * reduction)
    feature = torch.randn(2, 32, 16, 24)
    queries = Queries(
        points=torch.rand(50, 2) * torch.tensor([96.0, 64.0]) * reduction,
        owners=torch.randint(0, 2, (50,)),
        kernels=torch.randn(50, 32),
        boxes=torch.rand(50, 4) * 30 + 1,
        coarse=torch.randn(50),
    )
    with torch.no_grad():
        said = head(head.maps(photos, [p2, p2, p4, p4, p4], feature), queries)
        points, _, kernels, boxes, coarse = queries
        seen = [
            sampled(p2, queries, 4 * reduction),
            sampled(p4, queries, 16 * reduction),
            head.cue(sampled(feature, queries, 4 * reduction) * kernels),
            2 * (points - boxes[:, :2]) / boxes[:, 2:] - 1,
            coarse[:, None],
        ]
        if head.detail is not None:
            seen.append(sampled(head.detail(photos), queries, 2))
        weight = torch.cat(
            [head.fine.weight.flatten(1), head.semantic.weight.flatten(1), head.first.weight], 1
        )
        x = F.relu(torch.cat(seen, 1) @ weight.T + head.first.bias)
        for layer in (*head.later, head.last):
            joined = torch.cat([x, coarse[:, None]], 1)
            x = joined @ layer.weight.T + layer.bias
            x = x if layer is head.last else F.relu(x)
    torch.testing.assert_close(said, x[:, 0], atol=1e-5, rtol=1e-4)
    assert len(head.later) == 2


def test_the_photos_own_details_lie_where_they_are_looked_for() -> None:
    """A convolution that takes means puts a bright pixel back in its place."""
    detail = Detail(1)
    with torch.no_grad():
        for conv in (detail.first, detail.second):
            conv.weight.zero_()
            conv.bias.zero_()
        detail.first.weight[0, 0] = 1 / 16
        detail.second.weight[0, 0, 1, 1] = 1
        x = (torch.arange(32) + 0.5).expand(1, 1, 24, 32)
        ramp = torch.cat([x, torch.zeros(1, 2, 24, 32)], 1)
        told = detail(ramp)
    points = torch.rand(20, 2) * torch.tensor([26.0, 18.0]) + 3
    values = sample_maps(told, torch.zeros(20, dtype=torch.int64), points, stride=2)[:, 0]
    torch.testing.assert_close(values, points[:, 0])


def test_the_last_layer_starts_small() -> None:
    head = PointHead(TINY)
    assert head.last.weight.std().item() == pytest.approx(0.01, rel=0.5)
