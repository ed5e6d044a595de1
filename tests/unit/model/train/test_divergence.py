"""A training that has forgotten everything stops; a bad batch or two are none."""

from __future__ import annotations

import pytest

from fairyring.model.train.divergence import DivergenceError, Losses


def told(*losses: float) -> Losses:
    seen = Losses()
    for nth, loss in enumerate(losses):
        seen.add(loss, iteration=nth)
    return seen


def test_a_loss_of_hundreds_that_began_at_hundredths_is_told_in_a_sentence() -> None:
    with pytest.raises(
        DivergenceError, match=r"loss is 300 at iteration 9, and it began at 0\.06.*new folder"
    ):
        told(*[0.06] * 5, *[300.0] * 5)


def test_single_bad_batches_are_borne() -> None:
    told(*[0.06] * 5, 300.0, 300.0, 0.1, 0.1, 0.1, 300.0, 0.1, 300.0, 0.1)


def test_a_loss_that_is_low_is_not_far_above_one_that_was_nothing() -> None:
    told(*[0.0] * 5, *[9.0] * 20)


def test_a_loss_that_stays_as_it_began_is_no_divergence() -> None:
    told(*[19.0] * 5, *[19.0] * 20)
