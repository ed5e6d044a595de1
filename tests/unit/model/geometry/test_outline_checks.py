"""What may be stored as an outline or a mark, and what is repaired."""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.geometry.outline_checks import check_mark, check_outline
from fairyring.model.geometry.raster import mask_of_outline
from fairyring.model.geometry.shapes import (
    Circle,
    Ellipse,
    GeometryError,
    Mark,
    Polygon,
    area_of_outline,
    polygon_of_shape,
)

SQUARE = [10.0, 10.0, 50.0, 10.0, 50.0, 50.0, 10.0, 50.0]
BOW_TIE = [10, 10, 50, 50, 50, 10, 10, 50]
RING = [10, 10, 50, 10, 50, 50, 10, 50, 10, 10, 20, 20, 20, 40, 40, 40, 40, 20, 20, 20]

vertices = st.lists(st.tuples(st.integers(0, 30), st.integers(0, 30)), min_size=3, max_size=9)


def test_a_good_outline_comes_back_as_it_is_in_floats() -> None:
    dented = [10, 10, 50, 10, 50, 50, 30, 12, 10, 50]
    checked = check_outline([SQUARE, dented], width=100, height=80)

    assert checked == [SQUARE, dented]
    assert {type(value) for part in checked for value in part} == {float}


def test_repeated_vertices_are_removed() -> None:
    closed = [10, 10, 10, 10, 50, 10, 50, 50, 10, 50, 10, 10]

    (part,) = check_outline([closed], width=100, height=80)

    assert sorted(zip(part[::2], part[1::2], strict=True)) == [(10, 10), (10, 50), (50, 10), (50, 50)]


def test_a_hole_behind_a_bridge_is_left_alone() -> None:
    assert check_outline([RING], width=100, height=80) == [RING]


@pytest.mark.parametrize(
    "part",
    [BOW_TIE, [10, 10, 30, 30, 50, 50, 50, 10, 30, 30, 10, 50]],
    ids=["crossing", "through a vertex"],
)
def test_a_figure_of_eight_becomes_its_two_halves(part: list[float]) -> None:
    checked = check_outline([part], width=100, height=80)

    halves = [{(10, 10), (10, 50), (30, 30)}, {(50, 10), (50, 50), (30, 30)}]
    assert sorted(map(_corners, checked), key=min) == sorted(halves, key=min)


def test_a_hole_run_the_same_way_round_as_the_rim_stays_a_hole() -> None:
    around = [10, 10, 50, 10, 50, 50, 10, 50, 10, 10, 20, 20, 40, 20, 40, 40, 20, 40, 20, 20]

    checked = check_outline([around], width=100, height=80)

    assert mask_of_outline(checked, height=80, width=100).sum() == 40 * 40 - 20 * 20
    assert area_of_outline(checked) == 40 * 40 - 20 * 20


def test_a_rim_run_round_twice_is_one_rim() -> None:
    assert [_corners(part) for part in check_outline([SQUARE + SQUARE], width=100, height=80)] == [
        {(10, 10), (50, 10), (50, 50), (10, 50)}
    ]


def test_a_stroke_that_runs_on_beyond_its_start_changes_only_there() -> None:
    stroke = [20, 20, 60, 20, 60, 60, 20, 60, 16, 16, 40, 24]

    (part,) = check_outline([stroke], width=100, height=80)

    # Its end runs outside the start as far as (28, 20), and within it from there on.
    assert _corners(part) == {(28, 20), (60, 20), (60, 60), (20, 60), (16, 16)}
    assert area_of_outline([part]) == 1696


def test_the_middle_of_a_star_drawn_in_one_stroke_is_covered() -> None:
    r, inner = 30.0, 30.0 * math.cos(math.radians(72)) / math.cos(math.radians(36))
    angles = np.arange(5) * 4 * math.pi / 5
    star = (np.stack([np.cos(angles), np.sin(angles)], axis=1) * r + 40).ravel().tolist()

    (part,) = check_outline([star], width=100, height=80)

    assert len(part) == 20
    assert area_of_outline([part]) == pytest.approx(5 * r * inner * math.sin(math.radians(36)))


def test_the_pen_s_loop_at_a_corner_is_not_a_second_part() -> None:
    # The first and the last edge cross at (11, 10), a pixel from the corner.
    knotted = [10, 10, 50, 10, 50, 50, 10, 50, 10, 11, 12, 9]

    (part,) = check_outline([knotted], width=100, height=80)

    assert area_of_outline([part]) == pytest.approx(40 * 40, abs=2)
    assert {(50, 10), (50, 50), (10, 50), (10, 11)} <= _corners(part)


def _corners(part: list[float]) -> set[tuple[float, float]]:
    return set(zip(part[::2], part[1::2], strict=True))


def test_a_figure_of_eight_costs_no_more_in_a_larger_image() -> None:
    def seconds(width: int, height: int) -> float:
        start = time.perf_counter()
        check_outline([BOW_TIE], width=width, height=height)
        return time.perf_counter() - start

    small, large = (min(seconds(side, side) for _ in range(7)) for side in (100, 8000))
    assert large < 10 * small


@given(points=vertices)
@settings(max_examples=300)
def test_what_has_passed_passes_again_as_it_is(points: list[tuple[int, int]]) -> None:
    try:
        checked = check_outline([[float(value) for point in points for value in point]], width=31, height=31)
    except GeometryError:
        return
    assert check_outline(checked, width=31, height=31) == checked


@given(points=vertices)
@settings(max_examples=300)
def test_vertices_stay_or_go_and_new_ones_lie_on_edges_that_cross(points: list[tuple[int, int]]) -> None:
    given_points = np.array(points, float)
    try:
        checked = check_outline([given_points.ravel().tolist()], width=31, height=31)
    except GeometryError:
        return
    starts, ends = given_points, np.roll(given_points, -1, axis=0)
    for corner in {corner for part in checked for corner in _corners(part)} - set(map(tuple, points)):
        along, away = ends - starts, np.array(corner) - starts
        share = np.clip((along * away).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-9), 0, 1)
        assert np.hypot(*(away - share[:, None] * along).T).min() < 1e-6


@pytest.mark.parametrize(
    ("outline", "reason"),
    [
        (None, "no parts"),
        ([], "no parts"),
        ([None], "flat list"),
        ([[]], "three points"),
        ([[1, 1, 5, 5]], "three points"),
        ([[1, 1, 5, 5, 1, 1, 5, 5, 1, 1]], "no area|three points"),
        ([[1, 1, 5, 1, 5]], "flat list"),
        ([[1, 1, 5, 1, 5, math.nan]], "finite"),
        ([[1, 1, 5, 1, 5, math.inf]], "finite"),
        ([[1, 1, 5, 1, 5, 10**400]], "finite"),
        ([[1, 1, 5, 1, 5, True]], "numbers"),
        ([[1, 1, 5, 1, 5, "7"]], "numbers"),
        ([[[1, 1], [5, 1], [5, 5]]], "numbers|flat"),
        ([[1, 1, 5, 1, 9, 1]], "no area"),
        ([[1, 1, 5, 1, 1e6, 9]], "far outside"),
        ([[1, 1, 5, 1, 1e300, 9]], "far outside"),
        ([[-40, 1, -30, 1, -30, 9]], "outside the image"),
        ([[1, 90, 9, 90, 9, 99]], "outside the image"),
        ([[float(v) for v in range(20_002)]], "points"),
        ([SQUARE] * 501, "501 parts"),
        ([polygon_of_shape(Circle(50, 40, 30), chord_error=1e-5)] * 60, "20000 points"),
    ],
)
def test_what_is_no_outline_is_refused_with_the_reason(outline: Any, reason: str) -> None:
    with pytest.raises(GeometryError, match=reason):
        check_outline(outline, width=100, height=80)


def test_an_outline_may_leave_the_image() -> None:
    part = polygon_of_shape(Circle(0, 40, 30))
    assert check_outline([part], width=100, height=80) == [part]


@pytest.mark.parametrize(
    ("mark", "reason"),
    [
        (Circle(math.nan, 1, 5), "finite"),
        (Circle(50, 40, 0), "radius"),
        (Circle(50, 40, -3), "radius"),
        (Circle(50, 40, 1e5), "radius"),
        (Circle(50, 40, 0.01), "radius"),
        (Circle(5000, 40, 5), "far outside"),
        (Circle(-20, 40, 19), "beside the image"),
        (Circle(50, 200, 117), "beside the image"),
        (Ellipse(200, 40, 90, 5, 30), "beside the image"),
        (Ellipse(50, 40, 10, 0.01, 0), "radius"),
        (Polygon([101.0, 1.0, 150.0, 1.0, 150.0, 50.0]), "beside the image"),
        (Polygon([50.0, 40.0, 50.5, 40.0, 50.5, 40.5]), "no area"),
        (Ellipse(50, 40, 10, 0, 0), "radius"),
        (Ellipse(50, 40, 10, 5, math.inf), "finite"),
        (Polygon([1, 1, 9, 9]), "three points"),
        (Polygon([1, 1, 5, 1, 9, 1]), "no area"),
        (Polygon([float(v) for v in BOW_TIE]), "crosses itself"),
    ],
)
def test_what_is_no_mark_is_refused_with_the_reason(mark: Mark, reason: str) -> None:
    with pytest.raises(GeometryError, match=reason):
        check_mark(mark, width=100, height=80)


def test_an_ellipse_that_nearly_meets_the_image_may_be_of_a_cap_that_shows_a_sliver_in_it() -> None:
    # Of a rendered cap whose outline, no ellipse, reaches two pixels into the photo.
    mark = Ellipse(892.7408, -59.9593, 59.3216, 57.9197, 75.7386)
    assert check_mark(mark, width=1280, height=720) == mark


def test_good_marks_are_returned_in_standard_form() -> None:
    assert check_mark(Circle(50, 40, 5), width=100, height=80) == Circle(50, 40, 5)
    assert check_mark(Ellipse(50, 40, 5, 9, 30), width=100, height=80) == Ellipse(50, 40, 9, 5, 120)
    assert check_mark(Polygon(SQUARE), width=100, height=80) == Polygon(SQUARE)


def test_usual_polygons_are_checked_fast_enough_for_an_import() -> None:
    parts = [polygon_of_shape(Circle(100, 100, 30 + i % 5)) for i in range(2000)]
    assert len(parts[0]) == 2 * 40

    def loop() -> float:
        start = time.perf_counter()
        for part in parts:
            check_outline([part], width=1280, height=720)
        return time.perf_counter() - start

    # 20 000 a second on a quiet machine; a fifth of it anywhere.
    assert min(loop() for _ in range(3)) < len(parts) / 4000
