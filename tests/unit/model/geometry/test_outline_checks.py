"""What may be stored as an outline or a mark, and what is repaired."""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.geometry.raster import check_mark, check_outline, mask_of_outline
from fairyring.model.geometry.self_contact import area_if_plainly_simple, self_contact
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


def crosses_by_brute_force(points: np.ndarray) -> bool:
    """Whether any two edges cross properly, pair by pair in exact integer arithmetic."""

    def side(p: Any, q: Any, r: Any) -> int:
        return int(np.sign((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])))

    edges = list(zip(points.tolist(), np.roll(points, -1, axis=0).tolist(), strict=True))
    return any(
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
    assert (self_contact(array) == "crosses") == crosses_by_brute_force(array)
    if area_if_plainly_simple(array[:, 0].tolist(), array[:, 1].tolist()):
        assert self_contact(array) == "none"


def test_the_star_seen_whole_from_its_middle_twice_round_is_not_taken_for_simple() -> None:
    angles = np.arange(5) * 4 * math.pi / 5
    xs, ys = (10 * np.cos(angles)).tolist(), (10 * np.sin(angles)).tolist()

    assert area_if_plainly_simple(xs, ys) == 0
    assert self_contact(np.stack([xs, ys], axis=1)) == "crosses"


def test_a_good_outline_comes_back_as_it_is_in_floats() -> None:
    dented = [10, 10, 50, 10, 50, 50, 30, 12, 10, 50]
    checked = check_outline([SQUARE, dented], width=100, height=80)

    assert checked == [SQUARE, dented]
    assert {type(value) for part in checked for value in part} == {float}


def test_repeated_vertices_go() -> None:
    closed = [10, 10, 10, 10, 50, 10, 50, 50, 10, 50, 10, 10]

    (part,) = check_outline([closed], width=100, height=80)

    assert sorted(zip(part[::2], part[1::2], strict=True)) == [(10, 10), (10, 50), (50, 10), (50, 50)]


def test_a_hole_behind_a_bridge_is_left_alone() -> None:
    assert check_outline([RING], width=100, height=80) == [RING]


@pytest.mark.parametrize(
    "part",
    [BOW_TIE, [10, 10, 30, 30, 50, 10, 50, 50, 30, 30, 10, 50]],
    ids=["crossing", "through a vertex"],
)
def test_a_figure_of_eight_becomes_what_it_covers(part: list[float]) -> None:
    checked = check_outline([part], width=100, height=80)

    assert np.array_equal(
        mask_of_outline(checked, height=80, width=100), mask_of_outline([part], height=80, width=100)
    )
    # Two triangles of 40 × 20 / 2.
    assert area_of_outline(checked) == pytest.approx(800, abs=25)


def test_a_figure_of_eight_costs_no_more_in_a_larger_image() -> None:
    def seconds(width: int, height: int) -> float:
        start = time.perf_counter()
        check_outline([BOW_TIE], width=width, height=height)
        return time.perf_counter() - start

    small, large = (min(seconds(side, side) for _ in range(7)) for side in (100, 8000))
    assert large < 10 * small


@given(points=vertices)
@settings(max_examples=300, deadline=None)
def test_what_passes_covers_what_was_given(points: list[tuple[int, int]]) -> None:
    part = [float(value) for point in points for value in point]
    try:
        checked = check_outline([part], width=31, height=31)
    except GeometryError:
        return
    assert np.array_equal(
        mask_of_outline(checked, height=31, width=31), mask_of_outline([part], height=31, width=31)
    )


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
        (Circle(5000, 40, 5), "far outside"),
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


def test_good_marks_pass() -> None:
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
