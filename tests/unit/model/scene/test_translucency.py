"""Light that creeps in flesh."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fairyring.model.scene.translucency import creep

ROWS, COLUMNS, RIM = 40, 80, 40


def step(*, left: float, right: float) -> np.ndarray:
    light = np.full((3, ROWS, COLUMNS), left, np.float32)
    light[:, :, RIM:] = right
    return light


@pytest.mark.parametrize("reach", [1.0, 2.0, 4.0])
def test_a_step_between_two_caps_becomes_as_soft_as_the_reach_says(reach: float) -> None:
    light = step(left=1.0, right=0.4)
    creep(light, np.ones((ROWS, COLUMNS), np.float32), reach=reach)
    for place in (-3, -1, 0, 2, 5):
        behind = 0.5 * (1 + math.erf((place + 0.5) / (reach * math.sqrt(2))))
        assert light[0, 20, RIM + place] == pytest.approx(1.0 - 0.6 * behind, abs=0.02)


def test_without_reach_a_step_stays_a_step() -> None:
    light = step(left=1.0, right=0.4)
    creep(light, np.ones((ROWS, COLUMNS), np.float32), reach=0)
    assert (light == step(left=1.0, right=0.4)).all()


def test_soil_takes_no_light_and_gives_none() -> None:
    flesh = np.ones((ROWS, COLUMNS), np.float32)
    flesh[:, RIM:] = 0
    light = step(left=1.0, right=0.1)
    creep(light, flesh, reach=2.5)
    assert light == pytest.approx(step(left=1.0, right=0.1), abs=1e-5)
