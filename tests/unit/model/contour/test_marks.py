import numpy as np
import pytest

from fairyring.model.contour.marks import whole_of_mark
from fairyring.model.geometry.shapes import Circle, Ellipse, Polygon


def polygon(points: np.ndarray) -> Polygon:
    return Polygon(points=points.ravel().tolist())


def on_ellipse(angles: np.ndarray, *, a=50.0, b=40.0, theta=30.0, centre=(200.0, 150.0)) -> np.ndarray:
    turn = np.radians(theta)
    x, y = a * np.cos(angles), b * np.sin(angles)
    return (
        np.column_stack([x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)]) + centre
    )


def test_a_circle_and_an_ellipse_stand_for_themselves():
    for mark in (Circle(cx=1, cy=2, r=3), Ellipse(cx=1, cy=2, a=4, b=3, theta_deg=10)):
        assert whole_of_mark(mark) is mark


def test_unevenly_placed_vertices_on_an_ellipse_give_that_ellipse():
    angles = np.radians([0, 10, 25, 60, 150, 190, 200, 300])
    found = whole_of_mark(polygon(on_ellipse(angles)))
    assert isinstance(found, Ellipse)
    assert (found.cx, found.cy, found.a, found.b, found.theta_deg) == pytest.approx(
        (200, 150, 50, 40, 30), abs=1e-2
    )


def test_a_square_gives_a_circle_around_its_middle():
    found = whole_of_mark(polygon(np.array([[0.0, 0], [10, 0], [10, 10], [0, 10]])))
    assert isinstance(found, Ellipse)
    assert (found.cx, found.cy) == pytest.approx((5, 5), abs=1e-3)
    assert found.a == pytest.approx(found.b, abs=1e-3)
    assert 5 < found.a < 7.08


@pytest.mark.parametrize(
    "points",
    [
        [0, 0, 5, 5],
        [0, 0, 5, 5, 10, 10, 20, 20, 3, 3, 1, 1],
        [1, 1, 1, 1, 1, 1],
        [0, 0, 1, float("nan"), 5, 5],
    ],
    ids=["two points", "a line", "one point", "not a number"],
)
def test_a_polygon_that_determines_no_ellipse_gives_none(points: list[float]):
    assert whole_of_mark(Polygon(points=points)) is None


def test_a_polygon_far_from_the_origin_keeps_its_centre_to_a_thousandth():
    angles = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    found = whole_of_mark(polygon(on_ellipse(angles, centre=(11000.25, 9000.75))))
    assert found is not None
    assert (found.cx, found.cy) == pytest.approx((11000.25, 9000.75), abs=1e-3)
