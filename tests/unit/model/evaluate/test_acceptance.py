"""How many images have to be looked at, against scipy and against drawing at random."""

import numpy as np
import pytest
from scipy.stats import binomtest, hypergeom

from fairyring.model.errors import FairyringError
from fairyring.model.evaluate.acceptance import chance_of_passing, sample_size
from fairyring.model.evaluate.intervals import wilson_interval


@pytest.mark.parametrize(
    ("lot", "wrong", "sample", "allowed"), [(200, 11, 50, 1), (1000, 51, 59, 0), (30, 5, 30, 4)]
)
def test_the_chance_of_passing_is_hypergeometric(lot, wrong, sample, allowed):
    expected = hypergeom(lot, wrong, sample).cdf(allowed)
    assert chance_of_passing(lot, wrong=wrong, sample=sample, allowed=allowed) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("lot", "allowed", "tolerated", "confidence"),
    [(200, 0, 0.05, 0.95), (1000, 2, 0.05, 0.9), (60, 1, 0.1, 0.99)],
)
def test_the_sample_is_the_smallest_that_catches_a_bad_lot(lot, allowed, tolerated, confidence):
    bad = int(tolerated * lot) + 1
    size = sample_size(lot, allowed=allowed, tolerated=tolerated, confidence=confidence)
    assert hypergeom(lot, bad, size).cdf(allowed) <= 1 - confidence
    assert hypergeom(lot, bad, size - 1).cdf(allowed) > 1 - confidence


def test_in_a_large_lot_it_is_the_rule_of_three():
    # 0.95 of being wrong nowhere in n: n = ln(0.05) / ln(0.95) = 58.4.
    assert sample_size(20_000, allowed=0, tolerated=0.05, confidence=0.95) in (58, 59)


def test_bad_lots_pass_as_rarely_as_was_wished_for():
    size = sample_size(100, allowed=1, tolerated=0.1, confidence=0.9)
    rng = np.random.default_rng(3)
    lot = np.arange(100) < 11
    passed = np.mean([rng.choice(lot, size, replace=False).sum() <= 1 for _ in range(4000)])
    assert passed <= 0.1 + 0.015


def test_a_small_lot_is_looked_at_whole():
    assert sample_size(5, allowed=0, tolerated=0.1, confidence=0.95) == 5
    assert sample_size(0, allowed=0, tolerated=0.1, confidence=0.95) == 0


@pytest.mark.parametrize("wrong_use", [{"tolerated": 1.0}, {"confidence": 1.0}, {"allowed": -1}])
def test_shares_that_make_no_sense_are_refused(wrong_use):
    with pytest.raises(FairyringError):
        sample_size(100, **({"allowed": 0, "tolerated": 0.05, "confidence": 0.95} | wrong_use))


@pytest.mark.parametrize(("found", "of"), [(12, 12), (0, 9), (194, 200), (1, 3)])
def test_the_interval_of_a_share_is_wilsons(found, of):
    expected = binomtest(found, of).proportion_ci(0.95, method="wilson")
    assert wilson_interval(found, of) == pytest.approx((expected.low, expected.high))


def test_of_nothing_everything_is_possible():
    assert wilson_interval(0, 0) == (0.0, 1.0)
