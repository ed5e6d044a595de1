"""A whole outline contains what is seen of the cap."""

from __future__ import annotations

import pytest
import shapely

from fairyring.model.geometry.rings import lists_of, outlines_of, rings_of
from fairyring.model.geometry.shapes import Circle, area_of_outline, points_of_part, polygon_of_shape
from fairyring.model.geometry.uniting import united, united_with

SQUARE = [10.0, 10.0, 30.0, 10.0, 30.0, 30.0, 10.0, 30.0]


def test_one_that_covers_what_is_seen_stays_as_it_is() -> None:
    whole = polygon_of_shape(Circle(20, 20, 15))
    assert united_with(whole, [SQUARE]) == [whole]


def test_corners_that_reach_out_are_part_of_it() -> None:
    # A square of 20 px and one half as wide that covers its right edge: 400 + 10 · 20 / 2.
    whole = [25.0, 10.0, 35.0, 10.0, 35.0, 30.0, 25.0, 30.0]
    (part,) = united_with(whole, [SQUARE])
    assert area_of_outline([part]) == pytest.approx(400 + 100)
    united = shapely.polygons(points_of_part(part))
    assert shapely.covers(united, shapely.polygons(points_of_part(SQUARE)))


def test_pieces_apart_stay_parts_and_what_they_enclose_is_filled() -> None:
    apart = [60.0, 60.0, 70.0, 60.0, 70.0, 70.0, 60.0, 70.0]
    whole = polygon_of_shape(Circle(20, 20, 15))
    areas = sorted(area_of_outline([part]) for part in united_with(whole, [SQUARE, apart]))
    assert areas == [pytest.approx(100), pytest.approx(area_of_outline([whole]))]
    # A frame around (20, 20), reached over a bridge: its hole is filled.
    frame = [0, 0, 40, 0, 40, 40, 0, 40, 0, 0, 5, 5, 5, 35, 35, 35, 35, 5, 5, 5, 0, 0]
    (filled,) = united_with(polygon_of_shape(Circle(20, 20, 10)), [[float(each) for each in frame]])
    assert area_of_outline([filled]) == pytest.approx(1600)


def test_each_of_many_is_united_in_its_own_way_and_keeps_its_place() -> None:
    whole = polygon_of_shape(Circle(20, 20, 15))
    covered, apart = [SQUARE], [SQUARE, [60.0, 60.0, 70.0, 60.0, 70.0, 70.0, 60.0, 70.0]]
    reaching = [[10.0, 10.0, 30.0, 10.0, 30.0, 40.0, 10.0, 40.0]]
    crescent = [[0.0, 0.0, 40.0, 0.0, 40.0, 40.0, 35.0, 5.0, 5.0, 5.0, 0.0, 40.0]]
    seen = [reaching, covered, crescent, apart, covered]
    found = lists_of(united(rings_of([whole] * len(seen)), outlines_of(seen)))
    assert (found[1], found[4]) == ([whole], [whole])
    for outline, parts in zip(found, seen, strict=True):
        polygons = [shapely.Polygon(points_of_part(part)) for part in [whole, *parts]]
        expected = shapely.union_all(polygons)
        written = shapely.union_all([shapely.Polygon(points_of_part(part)) for part in outline])
        assert written.symmetric_difference(expected).area < 1e-6
