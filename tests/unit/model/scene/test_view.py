"""The camera: where points and directions come to lie in the picture."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.scene.view import hang_camera, project, see_ground, turn

pitches = st.floats(0, 45)


@settings(max_examples=40)
@given(pitches)
def test_the_soil_in_the_middle_lies_in_the_middle_at_its_own_size(pitch: float) -> None:
    view = hang_camera(width=640, height=360, pitch_deg=pitch, distance=1.4)
    image, scale, z = project(view, np.array([[320.0, 180.0, 0.0]]))
    assert image[0] == pytest.approx((320, 180))
    assert (scale[0], z[0]) == pytest.approx((1, 0))


@settings(max_examples=40)
@given(pitches)
def test_projecting_the_soil_seen_under_a_pixel_gives_that_pixel_back(pitch: float) -> None:
    view = hang_camera(width=640, height=360, pitch_deg=pitch, distance=1.4)
    ground = see_ground(view)
    rows, columns = np.array([0, 100, 359]), np.array([639, 7, 320])
    soil = np.column_stack([ground.x[rows, columns], ground.y[rows, columns], np.zeros(3)]).astype(float)
    image, _, z = project(view, soil)
    np.testing.assert_allclose(image, np.column_stack([columns, rows]) + 0.5, atol=2e-3)
    np.testing.assert_allclose(z, ground.z[rows, columns], atol=2e-3)


def test_from_straight_above_up_is_towards_the_camera_and_leans_outwards_at_the_sides() -> None:
    view = hang_camera(width=1000, height=600, pitch_deg=0, distance=1.0)
    up = np.tile([0.0, 0.0, 1.0], (2, 1))
    middle, side = turn(view, np.array([[500.0, 300.0, 0.0], [900.0, 300.0, 0.0]]), up)
    np.testing.assert_allclose(middle, (0, 0, 1), atol=1e-12)
    assert side == pytest.approx((400 / np.hypot(400, 1000), 0, 1000 / np.hypot(400, 1000)))


def test_a_tilted_camera_sees_tops_lean_up_the_picture() -> None:
    view = hang_camera(width=640, height=360, pitch_deg=30, distance=1.4)
    ((x, y, z),) = turn(view, np.array([[320.0, 180.0, 0.0]]), np.array([[0.0, 0.0, 1.0]]))
    assert (x, y, z) == pytest.approx((0, -0.5, np.cos(np.radians(30))))
