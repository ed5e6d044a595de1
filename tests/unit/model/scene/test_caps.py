"""Shapes of caps against what the geometry of spheroids says."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.scene.caps import DIRECTIONS, Cap, _egg, _squeezed, polygon_of_cap, surface_of_cap

BOX = (0, 0, 120, 120)


def cap(*, tilt_deg: float, toward_deg: float, dome: float, base: float) -> Cap:
    tilt, toward = math.radians(tilt_deg), math.radians(toward_deg)
    axis = (math.sin(tilt) * math.cos(toward), math.sin(tilt) * math.sin(toward), math.cos(tilt))
    outline = 45 * _egg(np.array([axis]), np.array([dome]), np.array([base]))[0]
    return Cap((60.3, 58.8, 20.0), 45.0, axis, dome, base, outline)


tilted = st.builds(
    cap,
    tilt_deg=st.floats(0, 75),
    toward_deg=st.floats(0, 360),
    dome=st.floats(0.6, 1.0),
    base=st.floats(0.3, 0.75),
)


def test_from_above_a_cap_is_a_circle() -> None:
    np.testing.assert_allclose(cap(tilt_deg=0, toward_deg=0, dome=0.8, base=0.4).outline, 45, rtol=1e-12)


@settings(max_examples=40)
@given(tilt=st.floats(0, 80), toward=st.floats(0, 360), flat=st.floats(0.3, 1))
def test_a_tilted_spheroid_is_an_ellipse(tilt: float, toward: float, flat: float) -> None:
    shape = cap(tilt_deg=tilt, toward_deg=toward, dome=flat, base=flat)
    sine, cosine = math.sin(math.radians(tilt)), math.cos(math.radians(tilt))
    short = 45 * math.hypot(cosine, flat * sine)
    t = DIRECTIONS - math.radians(toward)
    x, y = shape.outline * np.cos(t), shape.outline * np.sin(t)
    np.testing.assert_allclose((x / short) ** 2 + (y / 45) ** 2, 1, rtol=1e-9)


@settings(max_examples=40)
@given(tilted)
def test_points_of_the_surface_lie_on_the_spheroid(shape: Cap) -> None:
    surface = surface_of_cap(shape, BOX)
    rows, columns = np.nonzero(surface.cover == 1)
    points = np.column_stack([columns + 0.5, rows + 0.5, surface.z[rows, columns]]) - shape.centre
    axis = np.array(shape.axis)
    up = points @ axis
    out2 = (points**2).sum(axis=1) - up**2
    flat = np.where(up >= 0, shape.dome, shape.base)
    np.testing.assert_allclose((out2 + (up / flat) ** 2) / 45**2, 1, atol=0.04)


@settings(max_examples=40)
@given(tilted)
def test_normals_are_square_to_the_surface(shape: Cap) -> None:
    surface = surface_of_cap(shape, BOX)
    slope_y, slope_x = np.gradient(surface.z.astype(float))
    steep = np.hypot(slope_x, slope_y)
    # Away from the outline, where a pixel's slope is no derivative, and from the seam of the two halves.
    smooth = (surface.cover == 1) & (steep < 1.2) & (np.abs(surface.rise) > 0.12)
    expected = np.stack([-slope_x, -slope_y, np.ones_like(steep)])
    lengths = np.linalg.norm(expected, axis=0) * np.linalg.norm(surface.normal, axis=0)
    cosine = ((expected * surface.normal).sum(axis=0) / lengths)[smooth]
    assert np.quantile(cosine, 0.02) > 0.995


@settings(max_examples=40)
@given(tilted)
def test_the_surface_covers_what_the_polygon_does(shape: Cap) -> None:
    x, y = np.reshape(polygon_of_cap(shape), (-1, 2)).T
    area = 0.5 * abs(x @ np.roll(y, 1) - y @ np.roll(x, 1))
    assert surface_of_cap(shape, BOX).cover.sum() == pytest.approx(area, rel=0.01)


def test_caps_that_meet_at_one_height_share_a_flat_border() -> None:
    outline = np.full((2, len(DIRECTIONS)), 30.0)
    centre = np.array([[100.0, 100.0], [150.0, 100.0]])
    squeezed = _squeezed(outline, centre, np.zeros(2), np.full(2, 30.0), 1.0)
    right = squeezed[0] * np.cos(DIRECTIONS) + 100
    left = squeezed[1] * np.cos(DIRECTIONS) + 150
    assert right.max() == pytest.approx(125, abs=0.6)
    assert left.min() == pytest.approx(125, abs=0.6)
    apart = _squeezed(outline, centre, np.array([0.0, 90.0]), np.full(2, 30.0), 1.0)
    np.testing.assert_allclose(apart, 30, atol=0.2)
