"""How caps come to stand."""

from __future__ import annotations

import numpy as np
import pytest

from fairyring.model.scene.growth import FLATNESS, grow, pairs_within, zoomed
from fairyring.model.scene.settings import Growth

GROUND = (0.0, 0.0, 900.0, 600.0)


def test_settled_caps_hardly_run_into_each_other() -> None:
    growth = Growth(squeeze=0.0, cluster=12.0, spread=0.6)
    stand = grow(growth, count=90, ground=GROUND, rng=np.random.default_rng(1))
    first, second = np.triu_indices(90, k=1)
    between = (stand.place[first] - stand.place[second]) / (1, 1, FLATNESS)
    reach = stand.radius[first] + stand.radius[second]
    overlap = np.maximum(1 - np.linalg.norm(between, axis=1) / reach, 0)
    assert overlap.max() < 0.35
    assert (overlap > 0.12).sum() < 20


def test_caps_come_up_inside_their_ground_and_point_upwards() -> None:
    stand = grow(Growth(), count=120, ground=GROUND, rng=np.random.default_rng(2))
    assert (stand.foot >= (0, 0)).all()
    assert (stand.foot <= (900, 600)).all()
    np.testing.assert_allclose(np.linalg.norm(stand.axis, axis=1), 1)
    assert (stand.axis[:, 2] > 0.3).all()
    assert (stand.place[:, 2] > 0).all()


def test_clusters_are_denser_than_single_caps() -> None:
    def nearest(growth: Growth) -> float:
        foot = grow(growth, count=60, ground=GROUND, rng=np.random.default_rng(3)).foot
        apart = np.linalg.norm(foot[:, None] - foot[None], axis=2) + 1e6 * np.eye(60)
        return float(np.median(apart.min(axis=1)))

    assert nearest(Growth(cluster=10, spread=0.6)) < 0.8 * nearest(Growth(cluster=1))


def test_pairs_are_those_closer_than_their_reaches() -> None:
    centre = np.array([[0.0, 0.0], [10.0, 0.0], [0.0, 30.0]])
    first, second = pairs_within(centre, np.array([6.0, 6.0, 5.0]))
    assert (first.tolist(), second.tolist()) == ([0], [1])


def test_diameters_stay_within_their_limits() -> None:
    stand = grow(Growth(), count=400, ground=GROUND, rng=np.random.default_rng(4))
    least, *_, most = Growth().diameters
    assert 2 * stand.radius.min() >= least
    assert 2 * stand.radius.max() <= most
    assert np.median(2 * stand.radius) == pytest.approx(Growth().diameters[2], rel=0.15)


def test_late_caps_lie_lower_and_nearer_to_others() -> None:
    def stand(tucked: float) -> tuple[float, float]:
        grown = grow(Growth(tucked=tucked), count=80, ground=GROUND, rng=np.random.default_rng(5))
        apart = np.linalg.norm(grown.foot[:, None] - grown.foot[None], axis=2) + 1e6 * np.eye(80)
        return float(np.mean(grown.place[:, 2] / grown.radius)), float(np.median(apart.min(axis=1)))

    (height, apart), (late_height, late_apart) = stand(0.0), stand(1.0)
    assert late_height < 0.85 * height
    assert late_apart < 0.85 * apart


def test_seen_at_twice_the_size_a_quarter_of_the_caps_covers_as_much() -> None:
    growth = zoomed(Growth(caps=(80, 120), diameters=(10, 20, 40, 80, 160)), 2.0)
    assert growth.caps == (20, 30)
    assert growth.diameters == (20, 40, 80, 160, 320)
