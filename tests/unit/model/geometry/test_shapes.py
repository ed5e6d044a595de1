"""The coordinate convention, shapes and their polygons."""

from __future__ import annotations

import math

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fairyring.model.geometry.shapes import (
    Circle,
    Ellipse,
    GeometryError,
    area_of_outline,
    bounds_of_outline,
    canonical_ellipse,
    centres_of_pixels,
    diameter_of_shape,
    ellipse_of_rotated_box,
    keypoint_of_centre,
    points_of_part,
    polygon_of_shape,
)

coordinates = st.floats(-500, 500)
radii = st.floats(0.5, 500)


def test_the_centre_of_a_disc_drawn_on_pixels_is_half_a_pixel_beyond_its_opencv_contour() -> None:
    rows, columns = np.mgrid[:40, :60] + 0.5
    disc = ((columns - 30.5) ** 2 + (rows - 20.5) ** 2 < 144).astype(np.uint8)
    (contour,), _ = cv2.findContours(disc, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)

    points = centres_of_pixels(contour)

    assert points.mean(axis=0) == pytest.approx([30.5, 20.5])


def test_a_coco_keypoint_is_a_pixel_index() -> None:
    assert keypoint_of_centre((10.5, 7.25)) == (10.0, 6.75)


@given(cx=coordinates, cy=coordinates, a=radii, b=radii, theta=st.floats(-720, 720))
def test_a_canonical_ellipse_is_the_same_curve_with_its_longer_axis_first(
    cx: float, cy: float, a: float, b: float, theta: float
) -> None:
    ellipse = canonical_ellipse(cx, cy, a, b, theta)

    assert ellipse.a >= ellipse.b
    assert 0 <= ellipse.theta_deg < 180
    # The end of the axis that was given lies on the canonical ellipse.
    x, y = a * math.cos(math.radians(theta)), a * math.sin(math.radians(theta))
    t = math.radians(ellipse.theta_deg)
    u, v = x * math.cos(t) + y * math.sin(t), y * math.cos(t) - x * math.sin(t)
    assert (u / ellipse.a) ** 2 + (v / ellipse.b) ** 2 == pytest.approx(1, abs=1e-6)


@pytest.mark.parametrize("theta", [0.0, 30.0, 90.0, 135.0, 179.0])
def test_an_ellipse_survives_a_fit_by_opencv(theta: float) -> None:
    ellipse = Ellipse(50.25, 40.75, 30.0, 20.0, theta)
    points = points_of_part(polygon_of_shape(ellipse, chord_error=0.01)).astype(np.float32)

    found = ellipse_of_rotated_box(cv2.fitEllipseDirect(points))

    assert (found.cx, found.cy, found.a, found.b) == pytest.approx((50.25, 40.75, 30, 20), abs=1e-3)
    turn = (found.theta_deg - theta + 90) % 180 - 90
    assert turn == pytest.approx(0, abs=0.05)


@given(r=st.floats(1, 2000), chord_error=st.floats(0.01, 0.5))
def test_no_edge_of_a_circle_s_polygon_sags_more_than_the_chord_error(r: float, chord_error: float) -> None:
    points = points_of_part(polygon_of_shape(Circle(0, 0, r), chord_error=chord_error))
    middles = (points + np.roll(points, -1, axis=0)) / 2

    assert np.hypot(*points.T) == pytest.approx(r)
    assert (r - np.hypot(*middles.T)).max() <= chord_error + 1e-9
    assert points.mean(axis=0) == pytest.approx([0, 0], abs=1e-9 * r)


def test_a_circle_s_polygon_has_no_more_vertices_than_it_needs() -> None:
    # An n-gon in a circle of radius 50 sags by 50 (1 - cos(π/n)): 0.0986 px at n = 50, 0.107 px at 48.
    assert len(polygon_of_shape(Circle(10, 20, 50))) == 2 * 50


def test_the_polygon_of_an_ellipse_keeps_its_centre_and_area() -> None:
    part = polygon_of_shape(Ellipse(12.5, 80.25, 40, 10, 33), chord_error=0.01)

    assert points_of_part(part).mean(axis=0) == pytest.approx([12.5, 80.25])
    assert area_of_outline([part]) == pytest.approx(math.pi * 40 * 10, rel=2e-3)


def test_the_area_of_parts_adds_up_whichever_way_they_run() -> None:
    square, triangle = [0, 0, 10, 0, 10, 10, 0, 10], [20, 0, 20, 6, 24, 0]

    assert area_of_outline([square, triangle]) == pytest.approx(100 + 12)
    assert area_of_outline([square[::-1]]) == pytest.approx(100)


def test_a_hole_behind_a_bridge_takes_its_area_away() -> None:
    ring = [0, 0, 10, 0, 10, 10, 0, 10, 0, 0, 2, 2, 2, 6, 6, 6, 6, 2, 2, 2]

    assert area_of_outline([ring]) == pytest.approx(100 - 16)


@given(points=st.lists(st.tuples(coordinates, coordinates), min_size=3, max_size=12), dx=coordinates)
def test_area_does_not_change_with_a_shift(points: list[tuple[float, float]], dx: float) -> None:
    here = [value for x, y in points for value in (x, y)]
    there = [value for x, y in points for value in (x + dx, y - dx)]

    assert area_of_outline([there]) == pytest.approx(area_of_outline([here]), abs=1e-6)


def test_bounds_are_those_of_all_parts() -> None:
    assert bounds_of_outline([[1, 2, 4, 2, 4, 5], [-1.5, 3, 0, 3, 0, 9.25]]) == (-1.5, 2, 5.5, 7.25)
    with pytest.raises(GeometryError, match="no points"):
        bounds_of_outline([])


def test_the_diameter_of_an_ellipse_is_that_of_the_circle_of_its_area() -> None:
    assert diameter_of_shape(Circle(0, 0, 7)) == 14
    assert diameter_of_shape(Ellipse(0, 0, 16, 4, 0)) == pytest.approx(16)
