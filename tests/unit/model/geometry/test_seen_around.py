"""Polygons that are seen all around from a point, and two of them united."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from fairyring.model.geometry.rings import Rings, parts_of, rings_of
from fairyring.model.geometry.seen_around import are_seen_around, turned_forwards, united_around

SQUARE = [10.0, 10.0, 30.0, 10.0, 30.0, 30.0, 10.0, 30.0]
CENTRE = np.array([[20.0, 20.0]])
radii = st.lists(st.integers(5, 40), min_size=5, max_size=14)


def flower(lengths: list[int], centre: tuple[float, float]) -> list[float]:
    """A polygon around a point, a vertex at each of evenly spaced angles so far from it."""
    turns = [2 * math.pi * nth / len(lengths) for nth in range(len(lengths))]
    return [
        round(figure, 2)
        for length, turn in zip(lengths, turns, strict=True)
        for figure in (centre[0] + length * math.cos(turn), centre[1] + length * math.sin(turn))
    ]


def polygon(rings: Rings, nth: int = 0) -> shapely.Polygon:
    return shapely.Polygon(np.reshape(parts_of(rings)[nth], (-1, 2)))


def test_a_square_is_seen_all_around_from_within_and_not_from_a_corner_or_outside():
    rings = rings_of([SQUARE, SQUARE, SQUARE])
    assert are_seen_around(rings, np.array([[20.0, 20.0], [10.0, 10.0], [40.0, 20.0]])).tolist() == [
        True,
        False,
        False,
    ]


def test_a_crescent_and_a_rim_run_through_twice_are_not():
    crescent = [0.0, 0.0, 40.0, 0.0, 40.0, 40.0, 30.0, 5.0, 10.0, 5.0, 0.0, 40.0]
    twice = SQUARE + SQUARE
    assert not are_seen_around(rings_of([crescent, twice]), np.array([[20.0, 20.0], [20.0, 20.0]])).any()


def test_polygons_are_turned_forwards():
    backwards = [10.0, 30.0, 30.0, 30.0, 30.0, 10.0, 10.0, 10.0]
    assert parts_of(turned_forwards(rings_of([SQUARE, backwards]))) == [SQUARE, SQUARE]


def test_a_cross_of_two_bars_has_twelve_corners():
    across, upright = [0, 15, 40, 15, 40, 25, 0, 25], [15, 0, 25, 0, 25, 40, 15, 40]
    first, second = (rings_of([[float(each) for each in bar]]) for bar in (across, upright))
    united, reached = united_around(first, second, CENTRE)
    assert reached.tolist() == [True]
    ends = {(0, 15), (40, 15), (40, 25), (0, 25), (15, 0), (25, 0), (25, 40), (15, 40)}
    assert {*map(tuple, united.points.tolist())} == ends | {(15, 15), (25, 15), (25, 25), (15, 25)}
    assert len(united.points) == 12


@pytest.mark.parametrize("inner", [SQUARE, [10.0, 10.0, 30.0, 10.0, 20.0, 30.0]])
def test_what_reaches_the_rim_and_no_further_changes_nothing(inner: list[float]):
    united, reached = united_around(rings_of([SQUARE]), rings_of([inner]), CENTRE)
    assert not reached.any()
    assert polygon(united).equals(polygon(rings_of([SQUARE])))


@given(pairs=st.lists(st.tuples(radii, radii, st.integers(-90, 90)), min_size=1, max_size=4))
def test_many_at_once_are_what_shapely_makes_of_each(pairs: list[tuple[list[int], list[int], int]]):
    centres = [(100.0 * nth + where, 50.0) for nth, (_, _, where) in enumerate(pairs)]
    first = rings_of([flower(pair[0], centre) for pair, centre in zip(pairs, centres, strict=True)])
    second = rings_of([flower(pair[1], centre) for pair, centre in zip(pairs, centres, strict=True)])
    points = np.array(centres)
    assert are_seen_around(first, points).all()
    united, reached = united_around(first, second, points)
    for nth in range(len(pairs)):
        expected = polygon(first, nth).union(polygon(second, nth))
        assert polygon(united, nth).symmetric_difference(expected).area < 1e-6
        outside = polygon(second, nth).difference(polygon(first, nth)).area
        assert outside > 0 if reached[nth] else outside < 1e-6
