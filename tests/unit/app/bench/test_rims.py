"""Rims of drawn pictures, whose figures are known."""

from __future__ import annotations

import numpy as np
import pytest

from fairyring.app.bench.rims import rim_figures, rim_profiles
from fairyring.app.bench.scene import RIMS
from fairyring.model.geometry.shapes import Outline

LEFT: Outline = [[20, 20, 60, 20, 60, 100, 20, 100]]
RIGHT: Outline = [[60, 20, 110, 20, 110, 100, 60, 100]]


def photo(*, left: int, right: int, line: int | None = None) -> np.ndarray:
    """Two fields that meet at x = 60, maybe with a line of two pixels there."""
    grey = np.full((120, 130), 5, np.uint8)
    grey[20:100, 20:60], grey[20:100, 60:110] = left, right
    if line is not None:
        grey[20:100, 59:61] = line
    return np.dstack([grey] * 3)


def test_only_rims_between_two_caps_are_read_and_from_both_of_them() -> None:
    profiles = rim_profiles(photo(left=200, right=150), [LEFT, RIGHT])
    # 80 px every 3 px, but for the ends, from either side.
    assert 2 * 22 <= len(profiles) <= 2 * 28
    inside, outside = profiles[:, 0], profiles[:, -1]
    assert sorted({*inside.round(), *outside.round()}) == [150, 200]
    assert rim_profiles(photo(left=200, right=150), [LEFT]).shape == (0, 11)


def test_a_step_has_no_dip_and_its_whole_height_in_two_pixels() -> None:
    figures = rim_figures(rim_profiles(photo(left=200, right=150), [LEFT, RIGHT]))
    assert figures["rim step 50 % (grey levels)"] == pytest.approx(50)
    # The profile passes the edge half way between two pixels: 200, 175, 150.
    assert figures["rim steepest 50 % (grey levels)"] == pytest.approx(25, abs=0.5)
    assert figures["rim dip 50 % (grey levels)"] == pytest.approx(0)
    assert figures["faint rims"] == 0


def test_a_line_darker_than_both_sides_is_a_dip() -> None:
    figures = rim_figures(rim_profiles(photo(left=200, right=190, line=120), [LEFT, RIGHT]))
    assert figures["rim step 50 % (grey levels)"] == pytest.approx(10)
    assert figures["rim dip 50 % (grey levels)"] == pytest.approx(70, abs=0.5)
    assert figures["faint rims"] == 0


def test_caps_of_one_tone_have_faint_rims() -> None:
    figures = rim_figures(rim_profiles(photo(left=200, right=194), [LEFT, RIGHT]))
    assert figures["faint rims"] == 1


def test_rims_of_real_photos_are_given_for_every_figure() -> None:
    profiles = rim_profiles(photo(left=200, right=150), [LEFT, RIGHT])
    assert sorted(rim_figures(profiles)) == sorted(RIMS)
