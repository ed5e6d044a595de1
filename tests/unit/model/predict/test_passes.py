"""The scales that a photo is passed at, and windows brought from one to the other."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fairyring.model.predict.overlaps import Window
from fairyring.model.predict.passes import (
    BEST,
    KNOWN,
    TWO_PASSES,
    Pass,
    first_scale,
    resized,
    scale_for,
    shrunk,
)


def pixels_of(diameter: float) -> float:
    return math.pi * diameter**2 / 4


def test_a_pass_takes_caps_by_their_diameter_in_the_scaled_photo() -> None:
    close = Pass(enlarged=1.5, least=20, most=40)
    taken = [width for width in (19, 21, 39, 41) if close.takes(pixels_of(width * 1.5))]
    assert taken == [21, 39]
    assert close.takes(pixels_of(50 * 1.5), slack=1.3)
    assert not close.takes(pixels_of(53 * 1.5), slack=1.3)


@given(st.floats(1, 1000))
def test_every_size_is_taken_from_one_of_two_looks(diameter: float) -> None:
    assert any(each.takes(pixels_of(diameter * each.enlarged)) for each in TWO_PASSES)


def test_photos_are_first_seen_no_wider_than_the_network_was_taught() -> None:
    assert first_scale(1280, 720) == first_scale(300, 200) == 1
    assert first_scale(4000, 3000) == first_scale(3000, 4000) == 0.32


def test_caps_that_the_network_knows_stay_as_they_are_and_others_are_brought_to_what_it_reads_best() -> None:
    assert scale_for(45, otherwise=1.0) == 1.0
    assert scale_for(135, otherwise=0.32) == 0.32
    assert 12 * scale_for(12, otherwise=1.0) == pytest.approx(BEST)
    assert 200 * scale_for(200, otherwise=1.0) == pytest.approx(BEST)
    assert KNOWN[0] < BEST < KNOWN[1]


def test_a_photo_never_vanishes() -> None:
    photo = np.full((3, 900, 3), 7, np.uint8)
    assert resized(photo, 0.01).shape == (1, 9, 3)
    assert resized(photo, 1.0) is photo


@pytest.mark.parametrize("enlarged", [1.5, 2.0])
@pytest.mark.parametrize("at", [(0, 0), (7, -3), (-4, 11)])
def test_an_edge_stays_where_it_is_when_its_window_is_shrunk(enlarged: float, at: tuple[int, int]) -> None:
    """Logits that fall with x are 0 along x = 13.3 pixels of the scaled photo, in either window."""
    x = at[0] + np.arange(60) + 0.5
    logits = np.tile((13.3 * enlarged - x).astype(np.float32), (40, 1))
    small = shrunk(Window(x=at[0], y=at[1], logits=logits), enlarged=enlarged)
    assert small.y == math.floor(at[1] / enlarged)
    middles = small.x + np.arange(small.logits.shape[1]) + 0.5
    assert np.interp(0, -small.logits[5], middles) == pytest.approx(13.3, abs=1e-3)
    assert small.logits.shape[0] == math.ceil((at[1] + 40) / enlarged) - small.y


def test_a_window_of_a_pass_that_is_not_enlarged_stays_what_it_is() -> None:
    window = Window(x=3, y=4, logits=np.ones((2, 2), np.float32))
    assert shrunk(window, enlarged=1) is window
