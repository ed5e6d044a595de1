import numpy as np
import pytest

from fairyring.model.contour.expectation import (
    corner_information,
    corners_that_count,
    expected_reach,
    reach_of,
    roundness,
)


def test_the_reach_of_an_ellipse_is_its_longest_radius_but_for_the_smoothing():
    stretch = 0.5 * np.log(50 / 40)
    for turn in np.radians([0, 35, 110]):
        shape = stretch * np.array([[np.cos(2 * turn), np.sin(2 * turn)]])
        reach = reach_of(np.log([np.sqrt(50 * 40)]), shape).log_radius[0]
        assert np.log(50) - 0.03 < reach < np.log(50)
    assert reach_of(np.log([40.0]), np.zeros((1, 2))).log_radius == pytest.approx(np.log([40.0]))


def test_the_slopes_of_the_reach_agree_with_its_differences():
    log_radius, shape = np.log([45.0]), np.array([[0.06, -0.04, 0.01, 0.02]])
    slope = reach_of(log_radius, shape).slope[0]
    for parameter in range(3):
        step = np.zeros(5)
        step[parameter] = 1e-6
        up = reach_of(log_radius + step[0], shape + step[1:]).log_radius[0]
        down = reach_of(log_radius - step[0], shape - step[1:]).log_radius[0]
        assert slope[parameter] == pytest.approx((up - down) / 2e-6, abs=1e-6)


def test_a_very_stretched_cap_is_drawn_back_less_than_in_proportion():
    # Two standard deviations are where Student's t has half the weight of the normal distribution.
    given = roundness(np.array([[0.0, 0.0], [0.1, 0.0], [0.0, 0.4]]), stretch=0.05)
    assert given == pytest.approx([400, 200, 400 / 17])


def test_the_less_of_its_circle_a_cap_fills_the_further_it_is_expected_to_reach():
    assert expected_reach(np.array([0.2, 0.5, 0.65, 0.8, 0.95])) == pytest.approx(
        [0.02, 0.02, 0.005, -0.01, -0.01]
    )


def test_corners_count_for_caps_more_than_half_in_sight():
    corner = np.array([[True, False], [True, False], [True, False]])
    counts = corners_that_count(corner, np.array([0.3, 0.5, 0.7]))
    assert counts[:, 0] == pytest.approx([0.018, 0.5, 0.982], abs=0.001)
    assert (counts[:, 1] == 0).all()


def test_a_corner_tells_most_of_an_outline_that_just_encloses_it_and_nothing_of_one_it_sticks_out_of():
    at_it, beyond, far_beyond, inside = corner_information(
        np.array([[-1e-6, -12.0, -40.0, 1.0]]), np.array([40.0])
    )[0]
    assert at_it == pytest.approx(1 / (0.16 * 40) ** 2)
    # At 0.3 radii a quarter of the weight is left, (1 + 1)⁻².
    assert beyond == pytest.approx(at_it / 4)
    assert 0 < far_beyond < at_it / 100
    assert inside == 0
