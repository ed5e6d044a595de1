import numpy as np
import pytest
from scipy.optimize import minimize

from fairyring.model.contour.circle import (
    circle_cost,
    enclosing_circle,
    minimum_distance_circle,
    pratt_circle,
)


def rim(*, centre=(300.0, 200.0), radius=40.0, degrees=360.0, points=180) -> np.ndarray:
    angle = np.radians(np.linspace(0, degrees, points, endpoint=False))
    return np.array(centre) + radius * np.column_stack([np.cos(angle), np.sin(angle)])


def lowest_cost(points: np.ndarray) -> float:
    """Equation 9 with the radius eliminated: for a fixed centre the best radius is the median distance."""

    def cost(centre: np.ndarray) -> float:
        return circle_cost(points, centre, float(np.median(np.hypot(*(points - centre).T))))

    starts = [points.mean(axis=0) + shift for shift in ([0, 0], [5, 5], [-20, -3])]
    options = {"xatol": 1e-6, "fatol": 1e-7, "maxiter": 600}
    return min(minimize(cost, start, method="Nelder-Mead", options=options).fun for start in starts)


@pytest.mark.parametrize("fit", [enclosing_circle, pratt_circle, minimum_distance_circle])
def test_a_full_rim_gives_its_circle(fit):
    found = fit(rim())
    assert (found.cx, found.cy, found.r) == pytest.approx((300, 200, 40), abs=2e-3)


@pytest.mark.parametrize("fit", [pratt_circle, minimum_distance_circle])
def test_a_quarter_of_a_rim_gives_the_same_circle(fit):
    found = fit(rim(degrees=90))
    assert (found.cx, found.cy, found.r) == pytest.approx((300, 200, 40), abs=1e-6)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("degrees", [120.0, 220.0, 360.0])
def test_equation_9_is_minimised_to_a_hundredth_of_a_per_cent(seed: int, degrees: float):
    rng = np.random.default_rng(seed)
    points = rim(degrees=degrees) + rng.normal(0, 1, (180, 2))
    points[rng.choice(180, 20, replace=False)] += rng.uniform(-15, 15, (20, 2))
    found = minimum_distance_circle(points)
    assert found is not None
    cost = circle_cost(points, np.array([found.cx, found.cy]), found.r)
    assert cost <= 1.0001 * lowest_cost(points)


def test_outliers_do_not_pull_the_minimum_distance_circle():
    points = np.concatenate([rim(), rim(centre=(325, 200))[:20]])
    found = minimum_distance_circle(points)
    assert found is not None
    assert (found.cx, found.cy, found.r) == pytest.approx((300, 200, 40), abs=0.05)


@pytest.mark.parametrize("fit", [pratt_circle, minimum_distance_circle])
@pytest.mark.parametrize(
    "points",
    [np.zeros((1, 2)), np.ones((7, 2)), np.column_stack([np.arange(9.0), 2 * np.arange(9.0) + 1])],
    ids=["one point", "the same point", "a line"],
)
def test_points_that_determine_no_circle_give_none(fit, points: np.ndarray):
    assert fit(points) is None
