"""What a closed polygon that runs through itself covers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.geometry.shapes import signed_area
from fairyring.model.geometry.winding import FillRule, covered_parts, winding_numbers

vertices = st.lists(st.tuples(st.integers(0, 30), st.integers(0, 30)), min_size=3, max_size=9)
PLACES = np.stack(np.meshgrid(np.arange(30) + 0.383, np.arange(30) + 0.619), axis=-1).reshape(-1, 2)
"""On no line through two points of a small grid."""


def turns_by_angles(place: np.ndarray, polygon: np.ndarray) -> int:
    """How often the polygon runs round a place: the angles under which its edges are seen, added up."""
    seen = [math.atan2(y, x) for x, y in (polygon - place).tolist()]
    steps = [
        (after - before + math.pi) % (2 * math.pi) - math.pi
        for before, after in zip(seen, seen[1:] + seen[:1], strict=True)
    ]
    return round(sum(steps) / (2 * math.pi))


@given(points=vertices)
@settings(max_examples=100)
def test_turns_are_the_angles_added_up(points: list[tuple[int, int]]) -> None:
    polygon, places = np.array(points, float), PLACES[::17]

    assert winding_numbers(places, polygon).tolist() == [turns_by_angles(place, polygon) for place in places]


@given(points=vertices, rule=st.sampled_from(["nonzero", "evenodd"]))
@settings(max_examples=200)
def test_parts_cover_what_the_rule_says_once(points: list[tuple[int, int]], rule: FillRule) -> None:
    polygon = np.array(points, float)
    turns = winding_numbers(PLACES, polygon)
    wanted = turns % 2 == 1 if rule == "evenodd" else turns != 0

    covered = np.zeros(len(PLACES), int)
    for part in covered_parts(polygon, rule=rule):
        covered += winding_numbers(PLACES, part) != 0

    assert np.array_equal(covered, wanted.astype(int))


def test_a_loop_within_a_loop_is_covered_by_one_rule_and_not_by_the_other() -> None:
    # A square of 10, and within it one of 4, run the same way round and reached along the diagonal.
    twice = np.array(
        [[0, 0], [10, 0], [10, 10], [0, 10], [0, 0], [3, 3], [7, 3], [7, 7], [3, 7], [3, 3]], float
    )

    for rule, area in (("nonzero", 100), ("evenodd", 84)):
        (part,) = covered_parts(twice, rule=rule)
        assert abs(signed_area(part)) == pytest.approx(area)


def test_specks_go_and_what_is_larger_stays() -> None:
    # Two triangles that meet at (10, 10): of 50 px² and, run the other way round, of 0.5.
    eight = np.array([[0, 0], [11, 11], [11, 10], [10, 10], [0, 10]], float)

    assert sorted(abs(signed_area(part)) for part in covered_parts(eight, rule="nonzero")) == [0.5, 50]
    (part,) = covered_parts(eight, rule="nonzero", speck=0.01)
    assert abs(signed_area(part)) == 50


def test_what_covers_nothing_has_no_parts() -> None:
    assert covered_parts(np.array([[0, 0], [5, 5], [9, 9]], float), rule="nonzero") == []
