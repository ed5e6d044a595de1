"""The CDR that a mark has by itself."""

from __future__ import annotations

import numpy as np
import pytest

from fairyring.model.evaluate.centres import centre_error
from fairyring.model.evaluate.human_floor import cdr_of_noise


def test_it_is_the_mean_cdr_of_centres_that_are_off_by_such_noise() -> None:
    noise = np.random.default_rng(1).normal(0, (1.5, 0.5), (20_000, 2))
    measured = [
        centre_error((x, y), (0.0, 0.0), width=640, height=480, diameter=None).cdr for x, y in noise.tolist()
    ]
    assert cdr_of_noise((1.5, 0.5), width=640, height=480) == pytest.approx(np.mean(measured), rel=0.01)


def test_a_mark_without_noise_has_none() -> None:
    assert cdr_of_noise((0.0, 0.0), width=640, height=480) == 0.0
