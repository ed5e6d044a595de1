import numpy as np
import pytest

from fairyring.model.contour.marks import reconstruction_of_mark, whole_of_mark
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


@pytest.mark.parametrize(("radius", "off"), [(30.0, 1.0), (10.0, 0.4)])
def test_a_circle_and_an_ellipse_placed_as_a_whole_are_off_by_a_click(radius: float, off: float):
    for mark in (Circle(cx=50, cy=60, r=radius), Ellipse(cx=50, cy=60, a=radius, b=radius, theta_deg=10)):
        assert reconstruction_of_mark(mark).fit.centre_sd == pytest.approx((off, off))


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


def rim(count: int, *, degrees: float = 360, r: float = 60.0, a_over_r: float = 1.0) -> np.ndarray:
    """Points at even angles on a part of a rim around (200, 150); all of it without its end twice."""
    angles = np.radians(np.linspace(0, degrees, count, endpoint=degrees < 360))
    return on_ellipse(angles, a=r * a_over_r, b=r / a_over_r, theta=0)


@pytest.mark.parametrize(("count", "sd"), [(10, 0.447), (20, 0.316), (25, 0.283)])
def test_the_deviation_of_a_polygon_is_that_of_its_number_of_points(count: int, sd: float):
    """√(2/n) for points each off by a pixel: at 1280 × 720 a CDR of .076, .054 and .048 %."""
    found = reconstruction_of_mark(polygon(rim(count)))
    assert found.fit.centre_sd == pytest.approx((sd, sd), abs=1e-3)


@pytest.mark.parametrize(("count", "degrees"), [(8, 360), (14, 240), (10, 120)])
def test_the_deviation_is_how_far_centres_are_off(count: int, degrees: float):
    chance = np.random.default_rng(1)
    places = rim(count, degrees=degrees)
    stated = reconstruction_of_mark(polygon(places)).fit.centre_sd
    clicked = [places + chance.normal(0, 1, places.shape) for _ in range(400)]
    found = [reconstruction_of_mark(polygon(each)).fit.centre for each in clicked]
    seen = np.std([centre for centre in found if centre is not None], axis=0)
    assert stated is not None
    assert seen / stated == pytest.approx([1, 1], abs=0.25)


def test_of_a_small_cap_points_are_placed_more_closely():
    found = reconstruction_of_mark(polygon(rim(10, r=5)))
    assert found.fit.centre_sd == pytest.approx((0.2 * 0.447, 0.2 * 0.447), abs=1e-3)


def test_a_polygon_round_an_oblong_cap_is_an_ellipse_and_a_short_arc_a_circle():
    whole = reconstruction_of_mark(polygon(rim(14, degrees=300, a_over_r=1.2)))
    assert isinstance(whole.fit.whole, Ellipse)
    assert (whole.fit.whole.a, whole.fit.whole.b) == pytest.approx((72, 50), abs=0.1)
    assert whole.proposal == "ellipse"
    part = reconstruction_of_mark(polygon(rim(10, degrees=120)))
    assert isinstance(part.fit.whole, Circle)
    assert (part.fit.whole.cx, part.fit.whole.cy, part.fit.whole.r) == pytest.approx((200, 150, 60), abs=0.01)
    assert part.proposal == "circle"
    assert "120° of the rim" in part.why


WAVE = (0.3, -0.4, 0.1, 0.5, -0.2, -0.5, 0.4, -0.1)


@pytest.mark.parametrize(
    "points",
    [
        on_ellipse(np.arange(8) / 7 - 0.5, a=60, b=60) + np.array(WAVE)[:, None],
        np.array([[0.0, 0], [100, 1], [200, 0], [100, -1]]),
        np.array([[0.0, 0], [30, 0.4], [60, 0.9], [90, 1.2], [120, 1.9], [150, 2.6]]),
        rim(6, degrees=40),
        np.array([[10.0, 10], [10.2, 10], [90, 90], [90.2, 90]]),
    ],
    ids=["57 degrees", "a needle", "nearly a line", "40 degrees", "two points, each twice"],
)
def test_points_that_determine_no_outline_are_said_to(points: np.ndarray):
    found = reconstruction_of_mark(polygon(points))
    assert (found.fit.whole, found.fit.centre) == (None, None)
    assert found.fit.refusal is not None
    assert found.fit.refusal.startswith("The mark determines no outline")
    assert "Place a circle (C)" in found.fit.refusal
    assert found.proposal == "circle"


@pytest.mark.parametrize("apart", [0.0, 0.001, 0.5, 1.0])
@pytest.mark.parametrize("corner", range(4))
def test_a_point_that_was_clicked_twice_counts_once(apart: float, corner: int):
    square = np.array([[100.0, 100], [160, 100], [160, 160], [100, 160]])
    twice = np.insert(square, corner + 1, square[corner] + (apart, apart / 2), axis=0)
    found = reconstruction_of_mark(polygon(twice)).fit
    once = reconstruction_of_mark(polygon(square)).fit
    assert isinstance(found.whole, Ellipse)
    assert isinstance(once.whole, Ellipse)
    assert found.centre == pytest.approx((130, 130), abs=0.6)
    assert found.whole.a == pytest.approx(once.whole.a, rel=0.03)
