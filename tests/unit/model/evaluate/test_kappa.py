"""Cohen's kappa and its interval, against statsmodels."""

from __future__ import annotations

import pytest

from fairyring.model.evaluate.kappa import kappa_of


def said(table: list[list[int]]) -> list[tuple[bool, bool]]:
    """So many things of which the first (row) and the second person (column) said no or yes."""
    return [(bool(a), bool(b)) for a in (0, 1) for b in (0, 1) for _ in range(table[a][b])]


# statsmodels 0.15.0: stats.inter_rater.cohens_kappa(table), of which kappa, kappa_low, kappa_upp.
@pytest.mark.parametrize(
    ("table", "kappa", "low", "high"),
    [
        ([[20, 5], [10, 15]], 0.4, 0.151092290476661, 0.6489077095233389),
        ([[88, 4], [3, 5]], 0.5501285347043704, 0.2539923443365547, 0.8462647250721861),
        ([[40, 9], [6, 45]], 0.6995192307692307, 0.5595903407506923, 0.8394481207877692),
    ],
)
def test_kappa_and_its_interval_are_those_of_statsmodels(
    table: list[list[int]], kappa: float, low: float, high: float
) -> None:
    found = kappa_of(said(table))
    assert (found.kappa, found.low, found.high) == pytest.approx((kappa, low, high))
    assert found.count == sum(map(sum, table))


def test_who_always_agrees_has_1_and_who_only_ever_says_one_thing_has_none() -> None:
    assert kappa_of(said([[7, 0], [0, 3]])).kappa == 1.0
    always = kappa_of(said([[10, 0], [0, 0]]))
    assert (always.kappa, always.agreed) == (None, 1.0)
    assert kappa_of([]).count == 0
