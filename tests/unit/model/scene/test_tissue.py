"""The flesh that feet are fused in."""

from __future__ import annotations

import numpy as np

from fairyring.model.scene.pixels import Image
from fairyring.model.scene.soil import Bare
from fairyring.model.scene.stalks import Stalk
from fairyring.model.scene.tissue import raise_tissue

ROWS, COLUMNS = 120, 160


def raised(feet: list[tuple[float, float]], *, amount: float) -> tuple[Image, Bare]:
    stalks = [Stalk((x, y, 0.0), (x, y, 30.0), 10.0, 8.0) for x, y in feet]
    bare = Bare(
        np.full((3, ROWS, COLUMNS), 0.02, np.float32),
        np.zeros((ROWS, COLUMNS), np.float32),
        np.zeros((3, ROWS, COLUMNS), np.float32),
    )
    return raise_tissue(bare, stalks, amount=amount, rng=np.random.default_rng(1)), bare


TRIO = [(70.0, 50.0), (94.0, 50.0), (82.0, 70.0)]


def test_the_gap_between_feet_that_stand_close_is_filled_with_pale_flesh() -> None:
    share, bare = raised(TRIO, amount=0.8)
    assert share[57, 82] > 0.9
    assert bare.colour[:, 57, 82].min() > 0.6
    assert bare.z[57, 82] > 10


def test_a_lone_foot_shows_none_beyond_its_stalk() -> None:
    share, _ = raised([(80.0, 60.0)], amount=0.8)
    assert share[60, 95] == 0


def test_far_from_all_feet_the_soil_stays_as_it_is() -> None:
    share, bare = raised(TRIO, amount=1.0)
    assert share[100:, :40].max() == 0
    assert (bare.colour[:, 100:, :40] == np.float32(0.02)).all()
    assert (bare.z[100:, :40] == 0).all()


def test_an_amount_of_nothing_raises_nothing() -> None:
    assert raised(TRIO, amount=0)[0].max() == 0
