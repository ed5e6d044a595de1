"""Outlines cut where the image ends."""

from __future__ import annotations

import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.geometry.clipping import clipped_outline
from fairyring.model.geometry.outline_checks import check_outline
from fairyring.model.geometry.raster import area_of_rle, rle_of_outline
from fairyring.model.geometry.shapes import (
    GeometryError,
    area_of_outline,
    bounds_of_outline,
    points_of_part,
)

WIDTH, HEIGHT = 100, 80


def clipped(*parts: list[float]) -> list[list[float]]:
    return clipped_outline([list(map(float, part)) for part in parts], width=WIDTH, height=HEIGHT)


def test_what_lies_inside_stays_as_it_is() -> None:
    outline = [[0.0, 0.0, 100.0, 0.0, 100.0, 80.0, 0.0, 80.0], [1.0, 2.0, 9.5, 2.0, 4.0, 8.0]]
    assert clipped_outline(outline, width=WIDTH, height=HEIGHT) is outline


def test_a_square_over_a_corner_keeps_its_quarter() -> None:
    (part,) = clipped([-10, -10, 10, -10, 10, 10, -10, 10])
    assert set(map(tuple, points_of_part(part).tolist())) == {(0, 0), (10, 0), (10, 10), (0, 10)}


def test_vertices_inside_stay_and_new_ones_lie_on_the_border() -> None:
    (part,) = clipped([90, 10, 120, 30, 90, 50, 70, 33.3])
    # The edges from (90, 10) and from (90, 50) reach x = 100 a third of the way to x = 120.
    assert part == pytest.approx([90, 10, 100, 16.66667, 100, 43.33333, 90, 50, 70, 33.3])


def test_a_crescent_that_leaves_and_comes_back_becomes_two_parts() -> None:
    pieces = clipped([-20, 10, 30, 10, 30, 20, -10, 20, -10, 50, 30, 50, 30, 60, -20, 60])
    assert sorted(bounds_of_outline([piece]) for piece in pieces) == [(0, 10, 30, 10), (0, 50, 30, 10)]


def test_pieces_beyond_a_corner_do_not_hang_together() -> None:
    pieces = clipped([-30, -30, 30, -30, 30, 20, 20, 20, 20, -20, -20, -20, -20, 40, 10, 40, 10, 50, -30, 50])
    assert sorted(bounds_of_outline([piece]) for piece in pieces) == [(0, 40, 10, 10), (20, 0, 10, 20)]


def test_a_hole_at_the_border_is_a_hole_no_more() -> None:
    # A ring of 40 × 40 with a hole of 20 × 20, joined by a bridge; its left half lies outside.
    ring = [
        -20,
        20,
        20,
        20,
        20,
        60,
        -20,
        60,
        -20,
        40,
        -10,
        40,
        -10,
        50,
        10,
        50,
        10,
        30,
        -10,
        30,
        -10,
        40,
        -20,
        40,
    ]
    pieces = clipped(ring)
    assert area_of_outline(pieces) == pytest.approx(20 * 40 - 10 * 20)
    drawn = rle_of_outline(pieces, width=WIDTH, height=HEIGHT)
    assert area_of_rle(drawn) == pytest.approx(600, abs=30)


@pytest.mark.parametrize(
    "part", [[110, 10, 120, 10, 115, 20], [100, 0, 110, 0, 100, 30], [0, -5, 9, -5, 9, 0]]
)
def test_an_outline_without_area_in_the_image_is_refused(part: list[float]) -> None:
    with pytest.raises(GeometryError, match="outside the image"):
        clipped(part)


def test_a_part_outside_goes_and_the_other_stays() -> None:
    assert clipped([110, 10, 120, 10, 115, 20], [1, 2, 9, 2, 4, 8]) == [[1, 2, 9, 2, 4, 8]]


places = st.tuples(st.integers(-40, 140), st.integers(-40, 120))


@given(st.lists(places, min_size=3, max_size=12))
@settings(max_examples=200)
def test_the_same_is_covered_as_by_the_outline_within_the_image(vertices: list[tuple[int, int]]) -> None:
    try:
        outline = check_outline([[v for place in vertices for v in place]], width=WIDTH, height=HEIGHT)
        pieces = clipped_outline(outline, width=WIDTH, height=HEIGHT)
    except GeometryError:
        return
    x, y, width, height = bounds_of_outline(pieces)
    assert min(x, y) >= 0
    assert x + width <= WIDTH
    assert y + height <= HEIGHT
    assert clipped_outline(pieces, width=WIDTH, height=HEIGHT) == pieces
    polygons = [shapely.polygons(points_of_part(part)) for part in outline]
    # What merely touches itself may be read in two ways.
    if all(polygon.is_valid for polygon in polygons):
        expected = shapely.unary_union(polygons).intersection(shapely.box(0, 0, WIDTH, HEIGHT)).area
        assert area_of_outline(pieces) == pytest.approx(expected, abs=0.01)
        again = check_outline(pieces, width=WIDTH, height=HEIGHT)
        assert area_of_outline(again) == pytest.approx(expected, abs=0.01)
