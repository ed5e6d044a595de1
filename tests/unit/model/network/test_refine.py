"""Drawing the edge: with a head that knows the truth, the truth comes out to the pixel."""

from __future__ import annotations

from typing import Any, cast

import pytest
import torch
from torch import Tensor

from fairyring.model.network.decode import Instances
from fairyring.model.network.point_rend import PointHead, PointMaps, Queries
from fairyring.model.network.refine import refine

DISCS = torch.tensor([[70.3, 60.8, 25.0], [105.0, 40.5, 14.2], [3.0, 100.0, 20.0]])
"""x, y, radius, photo pixels, in a photo of 160 × 128; the last reaches beyond it."""


def logits_at(discs: Tensor, points: Tensor) -> Tensor:
    """Above 0 inside of each point's disc."""
    return discs[:, 2] - torch.hypot(*(points - discs[:, :2]).T)


class Knowing:
    """Stands in for a point head; a kernel is the disc it asks for."""

    def __init__(self) -> None:
        self.asked: list[Queries] = []

    def __call__(self, _maps: PointMaps, queries: Queries) -> Tensor:
        self.asked.append(queries)
        return logits_at(queries.kernels, queries.points)


def instances(stride: int, *, smaller: float = 0.0) -> Instances:
    """What a coarse mask says of the discs: their logits, rough and a little shifted, px ``smaller``."""
    height, width = 128 // stride, 160 // stride
    rows, columns = torch.meshgrid(torch.arange(height), torch.arange(width), indexing="ij")
    middles = (torch.stack([columns, rows], -1).reshape(-1, 2) + 0.5) * stride
    torch.manual_seed(0)
    coarse = [
        logits_at(disc.expand(len(middles), 3), middles + 1.5) - smaller + torch.randn(len(middles))
        for disc in DISCS
    ]
    logits = torch.stack(coarse).reshape(3, height, width)
    return Instances(scores=torch.tensor([0.9, 0.8, 0.7]), kernels=DISCS, logits=logits)


@pytest.mark.parametrize("stride", [4, 8])
def test_edges_run_where_the_head_says(stride: int) -> None:
    head = Knowing()
    maps = cast("PointMaps", object())
    refined = refine(cast("PointHead", head), maps, instances(stride), image=5, mask_stride=stride)
    rows, columns = torch.meshgrid(torch.arange(128), torch.arange(160), indexing="ij")
    middles = torch.stack([columns, rows], -1).reshape(-1, 2) + 0.5
    for disc, (x, y, logits) in zip(DISCS, refined, strict=True):
        true = (logits_at(disc.expand(len(middles), 3), middles) > 0).reshape(128, 160)
        told = torch.zeros_like(true)
        for row, column in (logits > 0).nonzero().tolist():
            if 0 <= y + row < 128 and 0 <= x + column < 160:
                told[y + row, x + column] = True
        assert int((told != true).sum()) <= 1


def test_a_mask_that_was_too_small_grows_on_all_sides_and_is_not_cut_straight() -> None:
    head = Knowing()
    given = instances(8, smaller=10)
    refined = refine(cast("PointHead", head), cast("PointMaps", object()), given, image=0, mask_stride=8)
    for x, y, radius, (left, top, logits) in zip(*DISCS.T.tolist(), refined, strict=True):
        for side, along in ((0, 1), (1, 0)):
            told = (logits > 0).any(side).nonzero().flatten() + (left, top)[1 - along]
            middle = (x, y)[1 - along]
            assert told[0] == pytest.approx(middle - radius, abs=1.5)
            assert told[-1] + 1 == pytest.approx(middle + radius, abs=1.5)


def test_points_are_the_middles_of_pixels_of_each_size_in_turn() -> None:
    head = Knowing()
    refine(cast("PointHead", head), cast("PointMaps", object()), instances(8), image=5, mask_stride=8)
    strides = []
    for queries in head.asked:
        (stride,) = {s for s in (1, 2, 4) if bool(((queries.points / s) % 1 == 0.5).all())}
        strides.append(stride)
        assert queries.owners.unique().tolist() == [5]
        assert queries.coarse.shape == (len(queries.points),)
    # Discs of one window's size are asked about together.
    assert strides in ([4, 2, 1], [4, 2, 1] * 2, [4, 2, 1] * 3)


def test_boxes_are_those_of_the_coarse_masks() -> None:
    head = Knowing()
    given: Any = instances(4)
    refine(cast("PointHead", head), cast("PointMaps", object()), given, image=0, mask_stride=4)
    told = {
        tuple(kernel): tuple(box)
        for q in head.asked
        for kernel, box in zip(q.kernels.tolist(), q.boxes.tolist(), strict=True)
    }
    assert len(told) == 3
    for disc, logits in zip(DISCS.tolist(), given.logits, strict=True):
        rows, columns = (logits > 0).nonzero().T
        left, top = int(columns.min()), int(rows.min())
        right, bottom = int(columns.max()) + 1, int(rows.max()) + 1
        expected = (4 * left, 4 * top, 4 * (right - left), 4 * (bottom - top))
        assert told[tuple(disc)] == pytest.approx(expected)


def test_only_the_unclear_are_asked_again() -> None:
    head = Knowing()
    refine(cast("PointHead", head), cast("PointMaps", object()), instances(4), image=0, mask_stride=4)
    for queries in head.asked:
        for kernel in DISCS:
            mine = (queries.kernels == kernel).all(1)
            if mine.any():
                away = logits_at(kernel.expand(int(mine.sum()), 3), queries.points[mine]).abs()
                assert float(away.median()) < 8


def test_points_finer_than_asked_for_are_left_to_interpolation() -> None:
    head = Knowing()
    maps = cast("PointMaps", object())
    refine(cast("PointHead", head), maps, instances(8), image=0, mask_stride=8, finest=2)
    assert all(bool(((queries.points / 2) % 0.5 == 0).all()) for queries in head.asked)
    assert not any(bool((queries.points % 1 == 0.5).any()) for queries in head.asked)


def test_instances_that_are_hardly_caps_are_not_asked_about() -> None:
    head = Knowing()
    given = instances(4)._replace(scores=torch.tensor([0.9, 0.31, 0.29]))
    refined = refine(cast("PointHead", head), cast("PointMaps", object()), given, image=0, mask_stride=4)
    asked = {tuple(kernel) for queries in head.asked for kernel in queries.kernels.tolist()}
    assert asked == {tuple(disc) for disc in DISCS[:2].tolist()}
    assert len(refined) == 3
