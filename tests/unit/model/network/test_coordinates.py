"""Coordinates: those of a crop are those of the whole photo there."""

from __future__ import annotations

import pytest
import torch

from fairyring.model.network.coordinates import with_coordinates


def test_a_crop_keeps_the_coordinates_of_the_place_it_was_cut_from() -> None:
    # A photo of 640 × 320 and a crop of 128 × 64 from (64, 32) on, both at stride 8.
    photo = with_coordinates(torch.zeros(1, 3, 40, 80), torch.tensor([[-320.0, -160.0]]), extent=(320, 640))
    crop = with_coordinates(
        torch.zeros(1, 3, 8, 16), torch.tensor([[64.0 - 320, 32.0 - 160]]), extent=(64, 128)
    )
    assert photo.shape == (1, 5, 40, 80)
    torch.testing.assert_close(crop[:, 3:], photo[:, 3:, 4:12, 8:24])


def test_coordinates_are_those_worked_out_by_hand() -> None:
    features = torch.ones(2, 1, 2, 4)
    told = with_coordinates(features, torch.tensor([[-640.0, -360.0], [0.0, 0.0]]), extent=(720, 1280))
    assert told[0, 1, 0].tolist() == pytest.approx([-0.75, -0.25, 0.25, 0.75])
    assert told[0, 2, :, 0].tolist() == pytest.approx([-180 / 640, 180 / 640])
    assert told[1, 1, 1].tolist() == pytest.approx([0.25, 0.75, 1.25, 1.75])
    assert (told[:, 0] == 1).all()


def test_coordinates_take_the_features_precision() -> None:
    told = with_coordinates(torch.ones(1, 1, 2, 2, dtype=torch.bfloat16), torch.zeros(1, 2), extent=(64, 64))
    assert told.dtype == torch.bfloat16
