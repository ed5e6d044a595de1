"""Scores that can be read as probabilities: Platt's line through their log-odds (Platt, 1999)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

MOST_CERTAIN = 1e-6
"""Scores are kept this far from 0 and 1, whose log-odds are not finite."""
PRIOR = 5.0
"""Weight of the prior for unchanged scores, in detections, so that a few of them do not turn the line."""
LEAST_SLOPE = 0.05
"""Least slope of the line: above 0, so that the order of scores stays."""
UNCHANGED = np.array([1.0, 0.0])
"""The slope and shift that leave scores as they are."""
ACCURACY = 1e-9
MOST_STEPS = 100

Figures = NDArray[np.float64]


class Calibration(NamedTuple):
    """A line through log-odds: slope · log-odds + shift."""

    slope: float = 1.0
    shift: float = 0.0


def calibrated(scores: Figures, line: Calibration) -> Figures:
    """(n,) scores in 0…1 → (n,) probabilities, in the same order."""
    return 1 / (1 + np.exp(-(line.slope * _log_odds(scores) + line.shift)))


def uncalibrated(probability: float, line: Calibration) -> float:
    """The raw score that ``calibrated`` turns into this probability; 0 for 0."""
    if probability <= 0:
        return 0.0
    odds = float(_log_odds(np.array(probability)))
    return float(1 / (1 + np.exp(-(odds - line.shift) / line.slope)))


def fit_calibration(scores: Figures, right: Figures | NDArray[np.bool_]) -> Calibration:
    """The most likely line for (n,) raw scores of detections, given how right, 0 to 1, each of them (n,) is.

    Largest likelihood with a normal prior about no change; with no detections at all nothing is changed.
    """
    x, true = _log_odds(scores), right.astype(np.float64)
    line = _most_likely(x, true, start=np.array([1.0, 0.0]), free=[0, 1])
    if line[0] < LEAST_SLOPE:  # the cost is convex, so the best line that is allowed has the least slope
        line = _most_likely(x, true, start=np.array([LEAST_SLOPE, line[1]]), free=[1])
    return Calibration(*line.tolist())


def _most_likely(x: Figures, true: Figures, *, start: Figures, free: list[int]) -> Figures:
    """(slope, shift) by Newton's method, steps halved while they do not help; only ``free`` ones move."""
    inputs, line = np.stack([x, np.ones_like(x)]), start.copy()

    def cost(line: Figures) -> float:
        away = line - UNCHANGED
        odds = line @ inputs
        return float((np.logaddexp(0, odds) - true * odds).sum() + PRIOR / 2 * (away @ away))

    for _ in range(MOST_STEPS):
        likely = 1 / (1 + np.exp(-(line @ inputs)))
        gradient = inputs @ (likely - true) + PRIOR * (line - UNCHANGED)
        curvature = (inputs * likely * (1 - likely)) @ inputs.T + PRIOR * np.eye(2)
        step = np.zeros(2)
        step[free] = np.linalg.solve(curvature[np.ix_(free, free)], -gradient[free])
        before = cost(line)
        while cost(line + step) > before and np.abs(step).max() > ACCURACY:
            step /= 2
        line += step
        if np.abs(step).max() <= ACCURACY:
            break
    return line


def _log_odds(scores: Figures) -> Figures:
    inside = np.clip(scores, MOST_CERTAIN, 1 - MOST_CERTAIN)
    return np.log(inside / (1 - inside))
