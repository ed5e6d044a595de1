"""Scores that can be read as probabilities: Platt's line through their log-odds (Platt, 1999)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

MOST_CERTAIN = 1e-6
"""Scores are kept this far from 0 and 1, whose log-odds are not finite."""
PRIOR = 5.0
"""Weight of leaving scores as they are, in detections: a few of them do not turn the line around."""
LEAST_SLOPE = 0.05
"""Above 0, so that the order of scores stays."""

Figures = NDArray[np.float64]


class Calibration(NamedTuple):
    """log-odds → slope · log-odds + shift."""

    slope: float = 1.0
    shift: float = 0.0


def calibrated(scores: Figures, line: Calibration) -> Figures:
    """(n,) scores in 0…1 → (n,) probabilities, in the same order."""
    return 1 / (1 + np.exp(-(line.slope * _log_odds(scores) + line.shift)))


def uncalibrated(probability: float, line: Calibration) -> float:
    """The score that is told as this probability; 0 for 0."""
    if probability <= 0:
        return 0.0
    odds = float(_log_odds(np.array(probability)))
    return float(1 / (1 + np.exp(-(odds - line.shift) / line.slope)))


def fit_calibration(scores: Figures, right: NDArray[np.bool_]) -> Calibration:
    """The line by which (n,) scores say best how often detections like these are right, (n,).

    Largest likelihood with a normal prior about no change; with no detections at all nothing is changed.
    """
    x, sign = _log_odds(scores), np.where(right, 1.0, -1.0)

    def cost(line: Figures) -> tuple[float, Figures]:
        margin = sign * (line[0] * x + line[1])
        away = line - (1.0, 0.0)
        wrong = -sign / (1 + np.exp(margin))
        gradient = np.array([wrong @ x, wrong.sum()]) + PRIOR * away
        return float(np.logaddexp(0, -margin).sum() + PRIOR / 2 * (away @ away)), gradient

    found = minimize(cost, (1.0, 0.0), jac=True, bounds=((LEAST_SLOPE, None), (None, None)))
    return Calibration(*found.x.tolist())


def _log_odds(scores: Figures) -> Figures:
    inside = np.clip(scores, MOST_CERTAIN, 1 - MOST_CERTAIN)
    return np.log(inside / (1 - inside))
