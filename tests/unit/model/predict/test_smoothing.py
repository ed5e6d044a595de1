"""Horns and notches of predicted caps."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from fairyring.model.predict.smoothing import FEWEST, smoothed

SIDE = 60


def disc(radius: float = 20.0, *, x: float = 30.0, y: float = 30.0) -> NDArray[np.float32]:
    """Logits that are 0 on a circle and grow by one a pixel towards its middle."""
    rows, columns = np.mgrid[:SIDE, :SIDE] + 0.5
    return (radius - np.hypot(columns - x, rows - y)).astype(np.float32)


def test_a_round_cap_stays_what_it_is() -> None:
    np.testing.assert_array_equal(smoothed(disc()) > 0, disc() > 0)


@pytest.mark.parametrize("narrow", [1, 2, 3])
def test_a_horn_goes_and_the_cap_stays(narrow: int) -> None:
    horned = disc()
    horned[29 : 29 + narrow, 48:58] = 2.0
    lost = (horned > 0) & ~(smoothed(horned) > 0)
    assert lost[29 : 29 + narrow, 54:58].all()
    assert not (lost & (disc() > 1)).any()


@pytest.mark.parametrize("narrow", [1, 2, 4])
def test_a_notch_that_the_network_is_unsure_of_is_filled(narrow: int) -> None:
    notched = disc()
    notched[29 : 29 + narrow, 40:] = np.minimum(notched[29 : 29 + narrow, 40:], -1.0)
    assert (smoothed(notched) > 0)[disc() > 1].all()


def test_a_bud_that_lies_in_front_stays_in_front() -> None:
    bud = np.where(disc(4, x=44) > 0, np.float32(-5), disc())
    assert not (smoothed(bud) > 0)[disc(4, x=44) > 0].any()


def test_a_crescent_is_narrow_and_no_horn() -> None:
    crescent = np.minimum(disc(), -disc(20, x=33))
    held = crescent > 0
    assert (smoothed(crescent) > 0)[held].mean() > 0.75


def test_next_to_nothing_is_left_as_it_is() -> None:
    speck = np.where(disc(2.8) > 0, np.float32(1), np.float32(-1))
    assert 0 < np.count_nonzero(speck > 0) < FEWEST
    assert smoothed(speck) is speck
