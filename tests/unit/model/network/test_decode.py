"""Instances from feature maps and kernels made by hand."""

from __future__ import annotations

import math

import pytest
import torch
from msgspec.structs import replace

from fairyring.model.network.boxes import boxes_of
from fairyring.model.network.config import NetworkConfig
from fairyring.model.network.decode import DecodeConfig, decode
from fairyring.model.network.pr_solov2 import Outputs
from fairyring.model.network.refine import refine

CONFIG = NetworkConfig(reduction=1)
SQUARES = ((slice(2, 8), slice(3, 11)), (slice(20, 30), slice(18, 26)))
"""Rows and columns, cells of the mask."""


def outputs_of(cells: dict[tuple[int, int, int], tuple[float, int]], *, strength: float = 8.0) -> Outputs:
    """Outputs of two images; the second one's channels e are ±1 inside and outside of square e.

    ``cells``: level, row, column → logit, and the square that the cell's kernel asks for.
    """
    feature = torch.full((2, 3, 32, 32), -1.0)
    for channel, (rows, columns) in enumerate(SQUARES):
        feature[1, channel, rows, columns] = 1.0
    categories = [torch.full((2, side, side), -9.0) for side in (8, 6, 3, 2, 1)]
    kernels = [torch.zeros(2, 3, side, side) for side in (8, 6, 3, 2, 1)]
    for (level, row, column), (logit, square) in cells.items():
        categories[level][1, row, column] = logit
        kernels[level][1, square, row, column] = strength
    return Outputs(categories=categories, kernels=kernels, feature=feature, point_maps=None, sharp=None)


def sigmoid(x: float) -> float:
    return 1 / (1 + math.exp(-x))


def test_two_squares_come_out_best_first() -> None:
    outputs = outputs_of({(0, 1, 2): (1.0, 0), (0, 6, 5): (3.0, 1)})
    found = decode(outputs, 1, CONFIG, DecodeConfig())
    expected = [sigmoid(3) * sigmoid(8), sigmoid(1) * sigmoid(8)]
    assert found.scores.tolist() == pytest.approx(expected, rel=1e-5)
    assert boxes_of(found.logits > 0).tolist() == [[18, 20, 8, 10], [3, 2, 8, 6]]
    assert found.kernels.tolist() == [[0, 8, 0], [8, 0, 0]]


def test_nothing_in_a_photo_is_no_instances() -> None:
    outputs = outputs_of({(0, 1, 2): (1.0, 0)})
    found = decode(outputs, 0, CONFIG, DecodeConfig())
    assert found.scores.shape == (0,)
    assert found.logits.shape == (0, 32, 32)
    assert refine(None, None, found, image=0, mask_stride=4) == []


def test_cells_that_are_not_sure_enough_are_left_out() -> None:
    outputs = outputs_of({(0, 1, 2): (math.log(0.11 / 0.89), 0), (0, 6, 5): (math.log(0.09 / 0.91), 1)})
    assert decode(outputs, 1, CONFIG, DecodeConfig()).scores.tolist() == pytest.approx(
        [0.11 * sigmoid(8)], rel=1e-4
    )


def test_a_neighbour_of_a_better_cell_is_no_instance_of_its_own() -> None:
    outputs = outputs_of({(0, 6, 5): (3.0, 1), (0, 6, 6): (2.0, 1)})
    assert len(decode(outputs, 1, CONFIG, DecodeConfig()).scores) == 1
    assert len(decode(outputs, 1, CONFIG, DecodeConfig(window=1)).scores) == 2


def test_the_same_cap_seen_by_two_levels_is_lowered_once() -> None:
    outputs = outputs_of({(0, 6, 5): (3.0, 1), (1, 4, 4): (2.0, 1)})
    found = decode(outputs, 1, CONFIG, DecodeConfig())
    expected = [sigmoid(3) * sigmoid(8), sigmoid(2) * sigmoid(8) * math.exp(-2)]
    assert found.scores.tolist() == pytest.approx(expected, rel=1e-4)
    strict = decode(outputs, 1, CONFIG, DecodeConfig(least_score=0.2))
    assert strict.scores.tolist() == pytest.approx(expected[:1], rel=1e-4)


def test_masks_no_larger_than_their_levels_stride_are_dropped() -> None:
    # Square 0 has 48 cells, at levels of stride 8 and 32; a speck of 8 cells is no cap, one of 9 is.
    outputs = outputs_of({(4, 0, 0): (3.0, 0)})
    assert len(decode(outputs, 1, CONFIG, DecodeConfig()).scores) == 1
    for count, instances in ((8, 0), (9, 1)):
        outputs = outputs_of({(0, 0, 0): (3.0, 2)})
        outputs.feature[1, 2, 0, :count] = 1.0
        assert len(decode(outputs, 1, CONFIG, DecodeConfig()).scores) == instances
    # At half the resolution a cell of the mask is four times as large.
    outputs = outputs_of({(0, 0, 0): (3.0, 2)})
    outputs.feature[1, 2, 0, :3] = 1.0
    assert len(decode(outputs, 1, replace(CONFIG, reduction=2), DecodeConfig()).scores) == 1


def test_what_lies_beyond_a_levels_reach_is_no_part_of_its_caps() -> None:
    # Level 0 reaches 2/3 · 56 = 37.3 photo pixels, 9.3 cells; the middle of its last cell is at 30 cells.
    outputs = outputs_of({(0, 7, 7): (3.0, 0)})
    outputs.feature[1, 0] = 1.0
    found = decode(outputs, 1, CONFIG, DecodeConfig())
    assert boxes_of(found.logits > 0).tolist() == [[21, 21, 11, 11]]


def test_no_more_instances_come_out_than_asked_for() -> None:
    outputs = outputs_of({(0, 1, 2): (1.0, 0), (0, 6, 5): (3.0, 1)})
    assert len(decode(outputs, 1, CONFIG, DecodeConfig(most=1)).scores) == 1
    assert len(decode(outputs, 1, CONFIG, DecodeConfig(most_before_nms=1)).scores) == 1


def test_without_points_logits_are_enlarged() -> None:
    outputs = outputs_of({(0, 1, 2): (1.0, 0), (0, 6, 5): (3.0, 1)})
    found = decode(outputs, 1, CONFIG, DecodeConfig())
    canvas = torch.zeros(2, 128, 128, dtype=torch.bool)
    for nth, (x, y, logits) in enumerate(refine(None, None, found, image=1, mask_stride=4)):
        for row, column in (logits > 0).nonzero().tolist():
            canvas[nth, y + row, x + column] = True
    assert boxes_of(canvas).tolist() == [[72, 80, 32, 40], [12, 8, 32, 24]]
    # Bilinear corners are round: a few pixels of each go.
    for mask, area in zip(canvas, (32 * 40, 32 * 24), strict=True):
        assert area - 16 <= int(mask.sum()) <= area
