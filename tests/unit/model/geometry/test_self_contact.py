"""How often a closed polygon crosses itself, and whether it touches itself."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.geometry.self_contact import (
    MOST_CROSSINGS,
    MOST_PAIRS,
    PAIRS_AT_ONCE,
    area_if_plainly_simple,
    self_contact,
)
from fairyring.model.geometry.shapes import GeometryError
from tests.support import tangles

vertices = st.lists(st.tuples(st.integers(0, 30), st.integers(0, 30)), min_size=3, max_size=9)


def crossings_by_brute_force(points: np.ndarray) -> int:
    """How many pairs of edges cross properly, pair by pair in exact integer arithmetic."""

    def side(p: Any, q: Any, r: Any) -> int:
        return int(np.sign((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])))

    edges = list(zip(points.tolist(), np.roll(points, -1, axis=0).tolist(), strict=True))
    return sum(
        side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0
        for i, (a, b) in enumerate(edges)
        for c, d in edges[:i]
    )


@given(points=vertices)
@settings(max_examples=500)
def test_crossings_are_those_found_pair_by_pair(points: list[tuple[int, int]]) -> None:
    array = np.array([p for p, q in zip(points, points[1:] + points[:1], strict=True) if p != q], float)
    if len(array) < 3:
        return
    contact = self_contact(array)
    assert contact.crossings == crossings_by_brute_force(array)
    if area_if_plainly_simple(array[:, 0].tolist(), array[:, 1].tolist()):
        assert (contact.crossings, contact.touches) == (0, False)


def test_a_tangle_of_a_few_dozen_points_is_counted_out() -> None:
    points = tangles.scattered(40)
    assert self_contact(points).crossings == crossings_by_brute_force(points) > 100


def test_the_star_seen_whole_from_its_middle_twice_round_is_not_taken_for_simple() -> None:
    angles = np.arange(5) * 4 * math.pi / 5
    xs, ys = (10 * np.cos(angles)).tolist(), (10 * np.sin(angles)).tolist()

    assert area_if_plainly_simple(xs, ys) == 0
    assert self_contact(np.stack([xs, ys], axis=1)).crossings == 5


def test_the_bridge_to_a_hole_touches_and_does_not_cross() -> None:
    ring = np.array([[1, 1], [9, 1], [9, 9], [1, 9], [1, 1], [3, 3], [3, 6], [6, 6], [6, 3], [3, 3]], float)

    contact = self_contact(ring)

    assert contact.touches
    assert contact.crossings == 0


def test_a_rim_takes_few_comparisons_and_a_comb_as_many_whichever_way_it_is_turned() -> None:
    assert self_contact(tangles.star(10_000, inner=500)).pairs < 10 * 10_000
    assert self_contact(tangles.spiral(10_000, turns=5, thick=20)).pairs < 100 * 10_000
    for degrees in (0, 90):
        assert self_contact(tangles.comb(10_000, long=100, degrees=degrees)).pairs < 10 * 10_000


@pytest.mark.parametrize(
    "points",
    [
        tangles.comb(10_000, long=100, degrees=45),
        tangles.spiral(10_000, turns=150, thick=1),
        tangles.scattered(10_000),
    ],
    ids=["comb", "spiral", "scattered"],
)
def test_what_would_take_long_to_compare_is_refused_first(points: np.ndarray) -> None:
    with pytest.raises(GeometryError, match="10000 points has too many long edges side by side"):
        self_contact(points)


@pytest.mark.parametrize("points", [tangles.scattered(1000), tangles.trembling(9000)])
def test_crossings_are_not_counted_without_end(points: np.ndarray) -> None:
    # Beyond the limit the comparisons end with the block they are in.
    assert MOST_CROSSINGS < self_contact(points).crossings < MOST_CROSSINGS + PAIRS_AT_ONCE


def test_any_two_of_a_thousand_edges_may_be_compared() -> None:
    pairs = self_contact(tangles.comb(1000, long=100, degrees=45)).pairs
    assert 300_000 < pairs < 1000 * 999 / 2 < MOST_PAIRS
