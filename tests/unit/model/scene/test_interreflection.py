"""What surfaces throw on each other, where it can be worked out by hand: everywhere alike."""

from __future__ import annotations

import numpy as np
import pytest

from fairyring.model.scene.interreflection import CREAM, throw
from fairyring.model.scene.shine import Fallen

SHAPE = (48, 64)


def thrown(*, upward: float, opened: float, reflectance: float, amount: float) -> np.ndarray:
    """(3,): what is added to light of strength 1."""
    fallen = Fallen(
        np.ones((3, *SHAPE), np.float32),
        np.full(SHAPE, upward, np.float32),
        np.full(SHAPE, opened, np.float32),
    )
    throw(fallen, np.full((3, *SHAPE), reflectance, np.float32), amount=amount)
    assert np.ptp(fallen.light, axis=(1, 2)).max() < 1e-5
    return fallen.light[:, 24, 32] - 1


def test_level_ground_under_an_open_sky_gets_nothing() -> None:
    assert thrown(upward=1, opened=1, reflectance=0.8, amount=1) == pytest.approx(np.zeros(3), abs=1e-6)


def test_an_upright_rim_gets_half_of_what_its_surroundings_send() -> None:
    found = thrown(upward=0.5, opened=1, reflectance=0.8, amount=0.9)
    assert found == pytest.approx(np.array(CREAM) * 0.8 * 0.9 * 0.5, abs=1e-5)


def test_a_gap_gets_the_sum_of_all_bounces_between_its_walls() -> None:
    once = 0.8 * (1 - 0.4)
    bounces = sum(once**count for count in range(1, 60))
    found = thrown(upward=1, opened=0.4, reflectance=0.8, amount=1)
    assert found == pytest.approx(np.array(CREAM) * 0.8 * 0.4 * bounces, rel=1e-4)


def test_black_velvet_throws_nothing() -> None:
    assert thrown(upward=0.5, opened=0.4, reflectance=0.8, amount=0) == pytest.approx(np.zeros(3), abs=1e-6)
    assert thrown(upward=0.5, opened=0.4, reflectance=0, amount=1) == pytest.approx(np.zeros(3), abs=1e-6)
