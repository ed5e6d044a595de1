from dataclasses import replace

import numpy as np
import pytest

from fairyring.model.contour import harmonic
from fairyring.model.contour.expectation import SHARED_ERROR, Expected, expected_of
from fairyring.model.contour.harmonic import Evidence, Outlines, fit_outlines
from fairyring.model.contour.priors import DEFAULT
from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.model.geometry.shapes import Ellipse, points_on_ellipse

ANGLES = np.linspace(0, 2 * np.pi, 48, endpoint=False)


def evidence(
    points: np.ndarray,
    *,
    seen: np.ndarray | None = None,
    corner: np.ndarray | None = None,
    radius: float = 40.0,
) -> Evidence:
    count = len(points)
    return Evidence(
        points=points[None],
        weight=np.full((1, count), 5.0),
        seen=np.ones((1, count)) if seen is None else seen[None],
        noise=0.5,
        corner=np.zeros((1, count)) if corner is None else corner[None],
        reach=np.log([radius]),
        stretch=0.1,
        size=0.0,
        size_precision=0.0,
        expected=expected_of([None]),
    )


def circle(x: float, y: float, r: float) -> Outlines:
    return Outlines(np.array([[x, y]]), np.log([r]), np.zeros((1, 8)))


def fitted(given: Evidence, start: Outlines) -> harmonic.Estimate:
    return fit_outlines(given, start, DEFAULT, softness=(3, 2, 1, 1, 1, 1))


def test_points_on_an_ellipse_give_its_centre_axes_and_angle():
    true = Ellipse(cx=300, cy=200, a=44, b=38, theta_deg=30)
    found = fitted(evidence(points_on_ellipse(true, ANGLES)), circle(302, 199, 41)).outlines
    assert found.centre[0] == pytest.approx([300, 200], abs=0.01)
    assert np.exp(found.log_radius[0]) == pytest.approx(np.sqrt(44 * 38), abs=0.05)
    # The matrix [[u, v], [v, −u]] has the eigenvalue ½ log(a / b), along the angle of a.
    stretch = 0.5 * np.log(44 / 38)
    assert found.shape[0, :2] == pytest.approx(
        [stretch * np.cos(np.radians(60)), stretch * np.sin(np.radians(60))], abs=2e-3
    )


def said_to_be(mean: tuple[float, float, float, float, float], sd: list[float]) -> Expected:
    covariance = tuple(map(tuple, np.diag(np.square(sd)).tolist()))
    return expected_of([LikelyEllipse(parameters=mean, covariance=covariance)])


def test_what_is_expected_decides_where_the_rim_says_nothing():
    """Of a quarter of a rim the centre along it is well known, and across it hardly."""
    arc = points_on_ellipse(Ellipse(cx=300, cy=200, a=40, b=40, theta_deg=0), np.linspace(-0.4, 0.4, 24))
    alone = evidence(arc)
    told = replace(alone, expected=said_to_be((303, 200, np.log(37), 0, 0), [0.01, 0.01, 0.01, 0.05, 0.05]))
    found = fitted(told, circle(300, 200, 40)).outlines
    assert found.centre[0] == pytest.approx([303, 200], abs=0.4)
    assert np.exp(found.log_radius[0]) == pytest.approx(37, abs=0.4)


def test_what_is_expected_hardly_moves_a_rim_that_is_all_in_sight():
    rim = points_on_ellipse(Ellipse(cx=300, cy=200, a=40, b=40, theta_deg=0), ANGLES)
    told = replace(
        evidence(rim), expected=said_to_be((306, 200, np.log(37), 0, 0), [0.1, 0.1, 0.1, 0.05, 0.05])
    )
    found = fitted(told, circle(300, 200, 40)).outlines
    assert found.centre[0] == pytest.approx([300, 200], abs=0.1)
    assert np.exp(found.log_radius[0]) == pytest.approx(40, abs=0.1)


def test_expectation_and_rim_meet_at_the_mean_weighted_by_their_precisions():
    """A rim that knows x to a standard deviation s, and an expectation that counts as sure, share the way."""
    rim = points_on_ellipse(Ellipse(cx=300, cy=200, a=40, b=40, theta_deg=0), ANGLES)
    alone = fitted(evidence(rim), circle(300, 200, 40))
    sd = float(np.sqrt(alone.covariance[0, 0, 0]))
    told = replace(
        evidence(rim),
        expected=said_to_be(
            (300 + 40 * 0.002, 200, np.log(40), 0, 0), [sd / SHARED_ERROR, 1e3, 1e3, 1e3, 1e3]
        ),
    )
    assert fitted(told, circle(300, 200, 40)).outlines.centre[0, 0] == pytest.approx(300.04, abs=0.002)


def test_slopes_agree_with_differences_of_the_residuals():
    rng = np.random.default_rng(1)
    points = rng.normal([300, 200], 40, (1, 48, 2))
    centre, log_radius = np.array([[303.0, 196.0]]), np.log([40.0])
    shape = np.array([[0.05, -0.03, 0.01, 0.02, -0.01, 0.005, 0.004, -0.006]])

    def residual(step: np.ndarray) -> np.ndarray:
        moved = Outlines(centre + 40 * step[:2], log_radius + step[2], shape + step[3:])
        # In units of the radius, which is itself a parameter.
        return harmonic._linearised(points, moved)[0][0] / np.exp(moved.log_radius)

    slope = harmonic._linearised(points, Outlines(centre, log_radius, shape))[1][0] / 40
    for parameter in range(11):
        step = np.zeros(11)
        step[parameter] = 1e-6
        difference = -(residual(step) - residual(-step)) / 2e-6
        # u and v also enter by the ellipse's second order, which the slopes leave out: relative size u.
        assert slope[parameter] == pytest.approx(difference, abs=0.12 if parameter in (0, 1, 3, 4) else 1e-4)


def test_a_hidden_point_holds_the_outline_from_inside_only():
    rim = points_on_ellipse(Ellipse(cx=300, cy=200, a=40, b=40, theta_deg=0), ANGLES)
    hidden = (ANGLES > 0.5) & (ANGLES < 2)
    inside = np.where(hidden[:, None], (300, 200) + 0.7 * (rim - (300, 200)), rim)
    found = fitted(evidence(inside, seen=(~hidden).astype(float)), circle(300, 200, 38)).outlines
    assert found.centre[0] == pytest.approx([300, 200], abs=0.1)
    outside = np.where(hidden[:, None], (300, 200) + 1.03 * (rim - (300, 200)), rim)
    pushed = fitted(evidence(outside, seen=(~hidden).astype(float)), circle(300, 200, 38)).outlines
    assert pushed.centre[0, 1] > 200.1


def test_a_hidden_corner_of_the_hull_draws_the_outline_towards_it():
    rim = points_on_ellipse(Ellipse(cx=300, cy=200, a=40, b=40, theta_deg=0), ANGLES)
    hidden = (ANGLES > 0.3) & (ANGLES < 2.8)
    border = np.where(hidden[:, None], (300, 200) + 0.6 * (rim - (300, 200)), rim)
    border[12] = (300, 230)
    seen = (~hidden).astype(float)
    corner = (np.arange(48) == 12).astype(float)
    alone = fitted(evidence(border, seen=seen), circle(300, 200, 40)).outlines
    drawn = fitted(evidence(border, seen=seen, corner=corner), circle(300, 200, 40)).outlines
    assert drawn.centre[0, 1] < alone.centre[0, 1] - 0.1
    # The corner lies 10 px inside the true rim; what is visible of that keeps the outline from following far.
    assert drawn.centre[0, 1] > alone.centre[0, 1] - 2


def test_the_sizes_of_the_other_caps_tell_where_little_rim_does_not():
    rim = points_on_ellipse(Ellipse(cx=300, cy=200, a=40, b=40, theta_deg=0), ANGLES[:8])
    given = replace(evidence(rim), reach=np.log([60.0]))
    alone = fitted(given, circle(300, 200, 50)).outlines
    among = fitted(
        replace(given, size=float(np.log(40)), size_precision=0.2**-2), circle(300, 200, 50)
    ).outlines
    assert abs(among.log_radius[0] - np.log(40)) < abs(alone.log_radius[0] - np.log(40)) - 0.01


def test_a_few_wild_points_do_not_move_the_centre():
    rim = points_on_ellipse(Ellipse(cx=300, cy=200, a=42, b=39, theta_deg=70), ANGLES)
    rim[:5] += (25, 10)
    found = fitted(evidence(rim), circle(302, 201, 41)).outlines
    assert found.centre[0] == pytest.approx([300, 200], abs=0.15)


def test_a_third_harmonic_on_half_a_rim_does_not_pass_for_a_shift_of_the_centre():
    rim = 40 * np.exp(0.01 * np.cos(3 * ANGLES))
    whole = np.column_stack([300 + rim * np.cos(ANGLES), 200 + rim * np.sin(ANGLES)])
    found = fitted(evidence(whole), circle(300, 200, 40)).outlines
    assert found.centre[0] == pytest.approx([300, 200], abs=0.02)
    assert found.shape[0, 2] == pytest.approx(0.01, rel=0.1)


def test_less_rim_means_more_doubt():
    rim = points_on_ellipse(Ellipse(cx=300, cy=200, a=40, b=40, theta_deg=0), ANGLES)
    spread = []
    for degrees in (360, 240, 140):
        seen = (np.degrees(ANGLES) < degrees).astype(float)
        border = np.where(seen[:, None] > 0, rim, 0.8 * rim + 0.2 * np.array([300, 200]))
        fit = fitted(evidence(border, seen=seen), circle(300, 200, 40))
        spread.append(np.sqrt(np.trace(fit.covariance[0, :2, :2])) * 40)
    assert spread[0] < spread[1] < spread[2]
