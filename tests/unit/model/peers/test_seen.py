"""From a mask in its box to an outline in the photo."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from fairyring.model.geometry.shapes import signed_area
from fairyring.model.peers.seen import SeenCaps, detections_of, window_of


def test_a_window_holds_the_pixels_whose_middles_lie_in_the_box() -> None:
    corner, window = window_of(torch.ones(4, 4), torch.tensor([2.6, 3.4, 7.5, 9.49]), width=20, height=20)
    assert corner == (3, 3)
    assert window.shape == (6, 5)


def test_a_window_ends_where_the_photo_does() -> None:
    corner, window = window_of(torch.ones(4, 4), torch.tensor([-3.0, 15.0, 5.0, 30.0]), width=20, height=20)
    assert (corner, window.shape) == ((0, 15), (5, 5))
    _, none = window_of(torch.ones(4, 4), torch.tensor([25.0, 25.0, 30.0, 30.0]), width=20, height=20)
    assert none.size == 0


def test_a_slope_over_the_box_is_read_at_the_middles_of_pixels() -> None:
    slope = (torch.arange(8) + 0.5).expand(8, 8) / 8
    _, window = window_of(slope, torch.tensor([10.0, 10.0, 42.0, 42.0]), width=100, height=100)
    # From the middle of the first cell to that of the last it rises evenly.
    expected = (np.arange(32) + 0.5) / 32
    assert window[5, 2:-2] == pytest.approx(expected[2:-2], abs=1e-5)


def test_a_disc_in_a_box_becomes_an_outline_of_its_size_and_place() -> None:
    y, x = np.mgrid[:28, :28] + 0.5
    disc = torch.from_numpy(12 - np.hypot(x - 14, y - 14)).float()
    seen = SeenCaps(torch.tensor([0.8]), torch.tensor([[30.0, 20.0, 86.0, 76.0]]), [disc])
    [found] = detections_of(seen, width=200, height=100)
    [part] = found.outline
    points = np.array(part).reshape(-1, 2)
    assert found.score == pytest.approx(0.8)
    # 12 of 28 cells from the middle, in a box of 56 px: a radius of 24 px.
    assert abs(signed_area(points)) == pytest.approx(np.pi * 24**2, rel=0.01)
    assert points.mean(0) == pytest.approx([58, 48], abs=0.5)


def test_a_mask_without_a_pixel_is_no_cap() -> None:
    seen = SeenCaps(torch.tensor([0.8]), torch.tensor([[3.0, 2.0, 8.0, 7.0]]), [torch.full((4, 4), -1.0)])
    assert detections_of(seen, width=20, height=20) == []
