"""Intervals of means: as wide as chance makes them, and wider where caps of a photo go wrong together."""

from __future__ import annotations

import numpy as np
import pytest

from fairyring.model.evaluate.bootstrap import mean_interval


def test_of_caps_on_their_own_it_is_the_mean_and_two_standard_errors() -> None:
    figures = np.random.default_rng(1).normal(5, 2, 400)

    found = mean_interval(figures, np.zeros(400, np.int64))

    assert found is not None
    error = 1.96 * figures.std() / 20
    assert (found.mean, found.count, found.drawn) == (pytest.approx(figures.mean()), 400, "caps")
    assert (found.low, found.high) == pytest.approx((found.mean - error, found.mean + error), abs=error / 8)


def test_where_all_caps_of_a_photo_err_alike_there_are_no_more_figures_than_photos() -> None:
    of_photos = np.random.default_rng(2).normal(0, 1, 25)

    found = mean_interval(np.repeat(of_photos, 40), np.repeat(np.arange(25), 40))

    assert found is not None
    assert found.drawn == "images"
    # As of 25 figures; of 1000 it would be a sixth of that.
    assert found.high - found.low == pytest.approx(2 * 1.96 * of_photos.std() / 5, rel=0.15)


def test_photos_count_by_how_many_caps_they_have() -> None:
    images = np.repeat(np.arange(12), [100] + [1] * 11)

    found = mean_interval((images == 0).astype(np.float64), images)

    assert found is not None
    assert found.mean == pytest.approx(100 / 111)
    # A resample without the first photo (35 in 100) has the mean 0.
    assert found.low == 0


def test_the_same_figures_give_the_same_interval_and_no_figures_none() -> None:
    figures, images = np.arange(30.0), np.arange(30) // 10
    assert mean_interval(figures, images) == mean_interval(figures, images)
    assert mean_interval(np.zeros(0), np.zeros(0, np.int64)) is None
