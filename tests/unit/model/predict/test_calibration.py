"""Scores as probabilities."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize

from fairyring.model.predict.calibration import (
    LEAST_SLOPE,
    PRIOR,
    Calibration,
    calibrated,
    fit_calibration,
    uncalibrated,
)

scores = st.lists(st.floats(0, 1), min_size=1, max_size=30).map(np.array)


def test_a_calibration_without_change_leaves_scores_as_they_are() -> None:
    some = np.array([0.05, 0.3, 0.5, 0.99])
    assert calibrated(some, Calibration()) == pytest.approx(some, abs=1e-12)


def test_a_calibrated_score_is_that_worked_out_by_hand() -> None:
    # Odds of 3 to 1, squared and doubled: 18 to 1.
    assert calibrated(np.array([0.75]), Calibration(2.0, np.log(2))) == pytest.approx([18 / 19])


@given(scores, st.floats(0.05, 8), st.floats(-5, 5))
def test_the_order_stays_and_all_is_finite(some: np.ndarray, slope: float, shift: float) -> None:
    said = calibrated(np.sort(some), Calibration(slope, shift))
    assert np.isfinite(said).all()
    assert (np.diff(said) >= 0).all()
    assert ((said >= 0) & (said <= 1)).all()


def test_timid_scores_are_raised_to_how_often_they_are_right() -> None:
    rng = np.random.default_rng(4)
    said = rng.uniform(0.05, 0.95, 20000)
    true = 1 / (1 + np.exp(-(2.5 * np.log(said / (1 - said)) + 0.8)))
    line = fit_calibration(said, rng.uniform(size=said.size) < true)
    assert line.slope == pytest.approx(2.5, rel=0.05)
    assert line.shift == pytest.approx(0.8, abs=0.06)
    assert calibrated(said, line) == pytest.approx(true, abs=0.02)


@given(st.floats(0.01, 0.99), st.floats(0.5, 4), st.floats(-2, 2))
def test_a_probability_is_traced_back_to_its_score(probability: float, slope: float, shift: float) -> None:
    line = Calibration(slope, shift)
    score = uncalibrated(probability, line)
    assert calibrated(np.array(score), line) == pytest.approx(probability, rel=1e-3)
    assert uncalibrated(0.0, line) == 0.0


def test_few_detections_change_little_and_none_change_nothing() -> None:
    assert fit_calibration(np.zeros(0), np.zeros(0, bool)) == pytest.approx((1, 0))
    slope, shift = fit_calibration(np.array([0.6, 0.7]), np.array([False, True]))
    assert abs(slope - 1) < 0.2
    assert abs(shift) < 0.2


def test_scores_that_say_the_contrary_keep_their_order() -> None:
    said = np.linspace(0.1, 0.9, 200)
    assert fit_calibration(said, said < 0.5).slope >= 0.05


@given(st.integers(0, 10_000), st.integers(1, 300), st.floats(-3, 4), st.floats(-3, 3))
def test_the_line_is_the_one_that_scipy_finds(seed: int, count: int, slope: float, shift: float) -> None:
    rng = np.random.default_rng(seed)
    odds = np.clip(rng.normal(0, 3, count), -13, 13)  # beyond, scores are kept from certainty
    said, right = 1 / (1 + np.exp(-odds)), rng.uniform(size=count) < 1 / (1 + np.exp(-slope * odds - shift))

    def cost(line: np.ndarray) -> float:
        sign = np.where(right, 1.0, -1.0)
        away = line - (1.0, 0.0)
        return float(np.logaddexp(0, -sign * (line[0] * odds + line[1])).sum() + PRIOR / 2 * (away @ away))

    found = fit_calibration(said, right)
    best = minimize(cost, (1.0, 0.0), bounds=((LEAST_SLOPE, None), (None, None)), method="L-BFGS-B")
    assert cost(np.array(found)) <= best.fun + 1e-6
    assert found == pytest.approx(tuple(best.x), abs=2e-3)
