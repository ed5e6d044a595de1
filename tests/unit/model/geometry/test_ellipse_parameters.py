"""Ellipses as five numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fairyring.model.geometry.ellipse_parameters import (
    LikelyEllipse,
    ellipse_of,
    moved_parameters,
    parameters_of,
)
from fairyring.model.geometry.shapes import Circle, Ellipse, canonical_ellipse, points_on_ellipse

axes = st.floats(1, 300)
angles = st.floats(0, 179.9)
motions = (st.floats(0, 360), st.floats(0.3, 3), st.booleans())


def test_the_numbers_are_those_worked_out_by_hand() -> None:
    # Four times as long as wide, along y: r = 20, u = −½ log 4, v = 0.
    assert parameters_of(Ellipse(3.0, 5.0, 40.0, 10.0, 90.0)) == pytest.approx(
        [3, 5, math.log(20), -math.log(2), 0], abs=1e-12
    )
    assert parameters_of(Circle(3.0, 5.0, 7.0)) == pytest.approx([3, 5, math.log(7), 0, 0])


@given(axes, axes, angles)
def test_an_ellipse_comes_back(a: float, b: float, theta: float) -> None:
    there = canonical_ellipse(4.0, -2.0, a, b, theta)
    back = ellipse_of(parameters_of(there))
    assert (back.cx, back.cy, back.a, back.b) == pytest.approx((4.0, -2.0, there.a, there.b))
    if there.a > 1.01 * there.b:
        off = abs(back.theta_deg - there.theta_deg)
        assert min(off, 180 - off) == pytest.approx(0, abs=1e-6)


@given(st.builds(canonical_ellipse, st.just(4.0), st.just(-2.0), axes, axes, angles), *motions)
def test_it_moves_as_its_points_do(ellipse: Ellipse, turn: float, scale: float, mirrored: bool) -> None:
    sine, cosine = math.sin(math.radians(turn)), math.cos(math.radians(turn))
    linear = scale * np.array([[cosine, -sine], [sine, cosine]]) @ np.diag([-1.0 if mirrored else 1.0, 1.0])
    motion = np.column_stack([linear, [30.0, -7.0]])
    moved = ellipse_of(moved_parameters(parameters_of(ellipse), motion))
    points = points_on_ellipse(ellipse, np.linspace(0, 2 * math.pi, 12)) @ linear.T + motion[:, 2]
    away = points - (moved.cx, moved.cy)
    along = math.radians(moved.theta_deg)
    unit = np.array([[math.cos(along), -math.sin(along)], [math.sin(along), math.cos(along)]])
    across = away @ unit / (moved.a, moved.b)
    assert np.hypot(*across.T) == pytest.approx(np.ones(12), rel=1e-6)


def test_a_likely_ellipse_grows_with_its_photo() -> None:
    whole = LikelyEllipse(parameters=(10.0, 20.0, 2.0, 0.1, 0.0), covariance=((1.0,) * 5,) * 5)
    grown = whole.enlarged(np.array([2.0, 2.0]))
    assert grown.parameters == pytest.approx((20, 40, 2 + math.log(2), 0.1, 0))
    assert grown.covariance == whole.covariance
    assert grown.ellipse.a == pytest.approx(2 * whole.ellipse.a)
