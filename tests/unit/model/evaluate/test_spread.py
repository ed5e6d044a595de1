"""The ellipse that holds most of a cloud of shifts."""

from __future__ import annotations

import numpy as np
import pytest

from fairyring.model.evaluate.spread import axes_of_spread, ellipse_of_spread, reach_of


def test_it_holds_95_of_100_of_what_scatters_normally() -> None:
    moves = np.random.default_rng(2).multivariate_normal((1.0, -2.0), [[4.0, 1.5], [1.5, 1.0]], 20_000)
    radii, vectors = axes_of_spread(moves)
    turned = (moves - moves.mean(axis=0)) @ vectors
    assert np.mean(((turned / radii) ** 2).sum(axis=1) <= 1) == pytest.approx(0.95, abs=0.005)


def test_its_two_halves_lie_on_it() -> None:
    moves = np.random.default_rng(4).multivariate_normal((1.0, -2.0), [[4.0, 1.5], [1.5, 1.0]], 500)
    radii, vectors = axes_of_spread(moves)
    for half in ellipse_of_spread(moves):
        turned = (half - moves.mean(axis=0)) @ vectors
        assert ((turned / radii) ** 2).sum(axis=1) == pytest.approx(np.ones(len(half)))


def test_shifts_of_one_kind_alone_have_a_flat_one() -> None:
    upper, lower = ellipse_of_spread(np.array([[1.0, 2.0], [1.0, 2.0], [1.0, 2.0]]))
    assert upper == pytest.approx(lower)


def test_a_plot_reaches_all_of_a_few_points_and_most_of_many() -> None:
    even = np.array([(x, y) for x in (-4.0, 0.0, 4.0) for y in (-1.0, 1.0)] * 4)
    few = np.vstack([even, [(0.0, -40.0)]])
    # Its ellipse ends at 1.6 + 2.4477 · 8.06 = 21.3 px; the point lies beyond.
    assert reach_of(few) == pytest.approx(44.0)
    many = np.vstack([np.ones((990, 2)), [(12.0, 0.0)] * 10])
    assert reach_of(many) < 12.0


def test_a_plot_holds_the_whole_ellipse_also_where_points_lie_far_from_it() -> None:
    far_ones = np.vstack([np.ones((99, 2)), [(100.0, 0.0)]])
    slanted = np.random.default_rng(3).multivariate_normal((3.0, -1.0), [[9.0, 8.5], [8.5, 9.0]], 12)
    for moves in (far_ones, slanted, np.array([(1.0, 2.0), (1.1, 2.0), (5.0, -3.0)])):
        reach = reach_of(moves)
        for half in ellipse_of_spread(moves):
            assert np.abs(half).max() < reach
