"""The whole loss: its terms against loops, and gradients for everything that learns."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import torch
from torch import Tensor
from torch.nn import functional as F

from fairyring.model.network.config import PointRend
from fairyring.model.network.losses import focal_loss
from fairyring.model.network.objective import POINTS, Batch, losses_of
from fairyring.model.network.point_rend import Queries
from fairyring.model.network.point_sampling import sample_maps
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.network.targets import IGNORED
from fairyring.model.train.crops import Crop
from fairyring.model.train.data import batch_of
from tests.support.small_networks import tiny

SIDE = 64
DISCS = [(20.0, 24.0, 9.0), (44.5, 40.0, 12.0), (30.0, 50.0, 7.0)]


def crop_of(discs: list[tuple[float, float, float]], *, ignored: bool = False) -> Crop:
    y, x = np.mgrid[:SIDE, :SIDE] + 0.5
    masks = np.zeros((len(discs), SIDE, SIDE), np.uint8)
    for mask, (cx, cy, r) in zip(masks, discs, strict=True):
        mask[np.hypot(x - cx, y - cy) < r] = 1
    rng = np.random.default_rng(0)
    photo = rng.integers(0, 120, (SIDE, SIDE, 3), dtype=np.uint8)
    photo[masks.any(0)] += 100
    unlearnt = np.zeros((SIDE, SIDE), bool)
    unlearnt[:, :16] = ignored
    return Crop(
        photo=photo,
        origin=(-32.0, -32.0),
        masks=masks,
        boxes=np.array([(cx - r, cy - r, 2 * r, 2 * r) for cx, cy, r in discs]).reshape(-1, 4),
        centres=np.array([(cx, cy) for cx, cy, _ in discs]).reshape(-1, 2),
        ignored=unlearnt,
        wholes=np.full((len(masks), 5), np.nan),
    )


def batch_for(network: PRSOLOv2, *crops: Crop) -> Batch:
    return batch_of(crops, network.config, soft=True)


@pytest.mark.parametrize("reading", ["instance", "semantic", "off"])
def test_everything_that_learns_gets_a_gradient(reading: PointRend) -> None:
    network = tiny(point_rend=reading).train()
    batch = batch_for(network, crop_of(DISCS[:2]), crop_of(DISCS[1:]))
    losses = losses_of(network, network(batch.photos, batch.origins), batch)
    assert float(losses.points.detach()) > 0 or reading == "off"
    losses.total.backward()
    for name, value in network.named_parameters():
        assert value.grad is not None, name
        assert torch.isfinite(value.grad).all(), name
        assert value.grad.any(), name


@pytest.mark.parametrize("reading", ["instance", "semantic", "off"])
@pytest.mark.parametrize("ignored", [False, True])
def test_a_batch_without_caps_is_learnt_from(reading: PointRend, ignored: bool) -> None:
    network = tiny(point_rend=reading).train()
    batch = batch_for(network, crop_of([], ignored=ignored), crop_of([], ignored=ignored))
    losses = losses_of(network, network(batch.photos, batch.origins), batch)
    assert float(losses.mask.detach()) == 0
    losses.total.backward()
    assert torch.isfinite(losses.total)
    gradients = {name: value.grad for name, value in network.named_parameters() if value.grad is not None}
    assert all(torch.isfinite(gradient).all() for gradient in gradients.values())
    assert gradients["category_head.logit.bias"].any()


def test_a_crop_without_caps_beside_one_with_caps_changes_neither_masks_nor_points() -> None:
    network = tiny(point_rend="off").eval()
    alone, both = batch_for(network, crop_of(DISCS)), batch_for(network, crop_of([]), crop_of(DISCS))
    with torch.no_grad():
        one = losses_of(network, network(alone.photos, alone.origins), alone)
        two = losses_of(network, network(both.photos, both.origins), both)
    assert float(two.mask) == pytest.approx(float(one.mask), rel=1e-4)
    assert float(two.category) > float(one.category)


def near(middle: tuple[float, float], pixels: float, map_of_cells: torch.Tensor) -> torch.Tensor:
    """1 in the cells, 4 photo pixels a side, whose middles are within so many pixels on both axes."""
    rows, columns = map_of_cells.shape
    inside = torch.zeros(rows, columns)
    for row in range(rows):
        for column in range(columns):
            x, y = (column + 0.5) * 4 - middle[0] * columns * 4, (row + 0.5) * 4 - middle[1] * rows * 4
            inside[row, column] = float(max(abs(x), abs(y)) <= pixels)
    return inside


def test_terms_are_those_of_a_loop_over_cells() -> None:
    network = tiny().eval()
    batch = batch_for(network, crop_of(DISCS[:2], ignored=True), crop_of(DISCS[1:]))
    with torch.no_grad():
        outputs = network(batch.photos, batch.origins)
        losses = losses_of(network, outputs, batch)
    dice, focal, positives, ignored = [], 0.0, 0, 0
    for level, images in enumerate(batch.cells):
        for image, cells in enumerate(images):
            for row in range(cells.shape[0]):
                for column in range(cells.shape[1]):
                    cap = int(cells[row, column])
                    logit = outputs.categories[level][image, row, column]
                    if cap == IGNORED:
                        ignored += 1
                        continue
                    focal += float(focal_loss(logit[None], torch.tensor([cap >= 0])))
                    if cap < 0:
                        continue
                    positives += 1
                    kernel = outputs.kernels[level][image, :, row, column]
                    p = torch.einsum("e,ehw->hw", kernel, outputs.feature[image]).sigmoid()
                    middle = ((column + 0.5) / cells.shape[1], (row + 0.5) / cells.shape[0])
                    p = p * near(middle, 2 / 3 * network.config.scale_ranges[level][1], p)
                    q = F.avg_pool2d(batch.masks[cap : cap + 1].float(), 4)[0]
                    dice.append(1 - 2 * float((p * q).sum()) / float((p**2).sum() + (q**2).sum()))
    assert ignored > 0
    assert float(losses.mask) == pytest.approx(sum(dice) / positives, rel=1e-4)
    assert float(losses.category) == pytest.approx(focal / (positives + 1), rel=1e-4)
    total = float(losses.category) + 3 * float(losses.mask) + float(losses.points)
    assert float(losses.total) == pytest.approx(total, rel=1e-5)


def test_what_is_said_in_ignored_cells_costs_nothing() -> None:
    network = tiny(point_rend="off").eval()
    batch = batch_for(network, crop_of(DISCS[1:2], ignored=True))
    with torch.no_grad():
        outputs = network(batch.photos, batch.origins)
        before = losses_of(network, outputs, batch)
        for level, (cells,) in enumerate(batch.cells):
            outputs.categories[level][0][cells == IGNORED] += 7
        after = losses_of(network, outputs, batch)
    assert float(after.category) == float(before.category)


class Echo(torch.nn.Module):
    """Stands in for a point head: says the coarse logit again and keeps what it was asked."""

    def __init__(self) -> None:
        super().__init__()
        self.queries: list[Queries] = []

    def maps(self, _photos: Tensor, _pyramid: list[Tensor], _feature: Tensor) -> Any:
        return object()

    def forward(self, _maps: Any, queries: Queries) -> Tensor:
        self.queries.append(queries)
        return queries.coarse


def test_points_are_asked_of_one_positive_cell_of_each_cap_and_told_the_truth_there() -> None:
    network = tiny().eval()
    echo = Echo()
    network.point_head = echo  # pyright: ignore
    batch = batch_for(network, crop_of(DISCS[:1]), crop_of(DISCS[1:]))
    torch.manual_seed(3)
    with torch.no_grad():
        outputs = network(batch.photos, batch.origins)
        losses = losses_of(network, outputs, batch)
    (queries,) = echo.queries
    assert len(queries.points) == 3 * POINTS
    assert queries.owners.view(3, POINTS).unique(dim=1).tolist() == [[0], [1], [1]]
    places = [(0, 0), (1, 1), (1, 2)]
    said, true = [], []
    for (image, cap), of_cap in zip(places, torch.arange(3 * POINTS).view(3, POINTS), strict=True):
        points, box = queries.points[of_cap], queries.boxes[of_cap]
        mine = [
            outputs.kernels[level][image, :, row, column]
            for level, cells in enumerate(batch.cells)
            for row, column in (cells[image] == cap).nonzero().tolist()
        ]
        kernel = queries.kernels[of_cap[0]]
        assert any(torch.equal(kernel, one) for one in mine)
        cx, cy, r = DISCS[cap]
        # The box of the cells that are covered by half, which is within half a cell of the disc's own.
        assert box[0].tolist() == pytest.approx((cx - r, cy - r, 2 * r, 2 * r), abs=4)
        assert (points >= box[:, :2] - 4).all()
        assert (points <= box[:, :2] + box[:, 2:] + 4).all()
        logits = torch.einsum("e,ehw->hw", kernel, outputs.feature[image])[None, None]
        nothing = torch.zeros(POINTS, dtype=torch.int64)
        said.append(sample_maps(logits, nothing, points, stride=4)[:, 0])
        masks = batch.masks[cap][None, None]
        true.append(sample_maps(masks, nothing, points, stride=1)[:, 0])
    torch.testing.assert_close(torch.cat(said), queries.coarse, atol=1e-6, rtol=1e-4)
    expected = F.binary_cross_entropy_with_logits(torch.cat(said), torch.cat(true))
    assert float(losses.points) == pytest.approx(float(expected), rel=1e-4)


def test_the_points_of_reading_b_are_told_whether_any_cap_is_there() -> None:
    network = tiny(point_rend="semantic").eval()
    batch = batch_for(network, crop_of([]), crop_of(DISCS))
    with torch.no_grad():
        outputs = network(batch.photos, batch.origins)
        losses = losses_of(network, outputs, batch)
    assert outputs.sharp is not None
    y, x = np.mgrid[:SIDE, :SIDE] + 0.5
    inside = np.zeros((2, SIDE, SIDE), np.float32)
    for cx, cy, r in DISCS:
        inside[1][np.hypot(x - cx, y - cy) < r] = 1
    # Middles of 4 and 8 pixels lie on corners of pixels: a mean of four.
    corners = (inside[:, :-1, :-1] + inside[:, 1:, :-1] + inside[:, :-1, 1:] + inside[:, 1:, 1:]) / 4
    true = []
    for image in range(2):
        for px, py in outputs.sharp.points[image].long().tolist():
            true.append(corners[image, py - 1, px - 1])
    expected = F.binary_cross_entropy_with_logits(outputs.sharp.logits.flatten(), torch.tensor(true))
    assert float(losses.points) == pytest.approx(float(expected), rel=1e-4)


def test_the_points_of_reading_b_say_nothing_of_ground_that_nobody_speaks_of() -> None:
    network = tiny(point_rend="semantic").eval()
    made = crop_of(DISCS)
    unsaid = replace(made, ignored=made.masks.max(0) == 0)
    whole, part = batch_for(network, made), batch_for(network, unsaid)
    with torch.no_grad():
        outputs = network(whole.photos, whole.origins)
        assert outputs.sharp is not None
        x, y = outputs.sharp.points[0].long().unbind(1)
        told = whole.caps[0].masks.amax(0)[y, x] > 0
        before = losses_of(network, outputs, part).points
        outputs.sharp.logits[0][~told & (whole.caps[0].masks.amax(0)[y - 1, x - 1] == 0)] += 9
        assert float(losses_of(network, outputs, whole).points) > float(before) + 1
        after = losses_of(network, outputs, part).points
    assert float(after) == pytest.approx(float(before), abs=0.3)


def test_bf16_and_full_precision_agree_roughly() -> None:
    network = tiny().eval()
    batch = batch_for(network, crop_of(DISCS))
    found = []
    for enabled in (False, True):
        torch.manual_seed(0)
        with torch.no_grad(), torch.autocast("cpu", torch.bfloat16, enabled=enabled):
            losses = losses_of(network, network(batch.photos, batch.origins), batch)
        found.append([float(term) for term in losses])
    assert found[1] == pytest.approx(found[0], rel=0.05)
