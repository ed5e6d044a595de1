"""The strokes by which a scripted annotator puts outlines right."""

from __future__ import annotations

import numpy as np
import pytest

from fairyring.app.bench.strokes import distances_to, round_of, stray_line

SQUARE = [0.0, 0.0, 40.0, 0.0, 40.0, 40.0, 0.0, 40.0]
DENTED = [0.0, 0.0, 40.0, 0.0, 40.0, 15.0, 25.0, 20.0, 40.0, 25.0, 40.0, 40.0, 0.0, 40.0]
"""The square with a piece missing at the right, from y = 15 to 25."""


def test_a_stroke_round_a_cap_comes_back_to_where_it_began():
    points = round_of(SQUARE)

    assert np.array_equal(points[0], points[-1])
    assert np.hypot(*np.diff(points, axis=0).T) == pytest.approx(np.ones(160))


def test_only_where_an_outline_strays_is_it_redrawn_and_a_little_beyond():
    line = stray_line(DENTED, SQUARE)

    assert set(line[:, 0]) == {40.0}
    low, high = line[:, 1].min(), line[:, 1].max()
    assert 10 < low < 15
    assert 25 < high < 30
    assert distances_to(DENTED, line[[0, -1]]) == pytest.approx([0, 0])


def test_an_outline_that_is_right_nowhere_is_redrawn_all_round():
    inside = [10.0, 10.0, 30.0, 10.0, 30.0, 30.0, 10.0, 30.0]

    assert len(stray_line(inside, SQUARE)) == 160
