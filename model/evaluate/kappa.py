"""Cohen's kappa: how much more two people agree than they would by chance."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from statistics import NormalDist

from msgspec import Struct


class Kappa(Struct, frozen=True, kw_only=True):
    """Agreement on a yes or no; figures are None where it is not defined."""

    kappa: float | None
    """1 where both always agree, 0 where no more than by chance; None where both always say one thing."""
    low: float | None
    """Between ``low`` and ``high`` it lies with the confidence asked for."""
    high: float | None
    agreed: float | None
    """Share of the caps on which both say the same."""
    count: int


def kappa_of(said: Sequence[tuple[bool, bool]], *, confidence: float = 0.95) -> Kappa:
    """Kappa of what two people said of the same things, with its large-sample interval.

    Sources: J. Cohen, Educational and Psychological Measurement 20 (1960), 37-46; J. L. Fleiss, J. Cohen and
    B. S. Everitt, Psychological Bulletin 72 (1969), 323-327.

    Args:
        said: what the first and the second person said of each thing.
        confidence: of the interval, between 0 and 1.
    """
    count = len(said)
    if not count:
        return Kappa(kappa=None, low=None, high=None, agreed=None, count=0)
    shares = [[sum(pair == (a, b) for pair in said) / count for b in (False, True)] for a in (False, True)]
    first = [sum(row) for row in shares]
    second = [shares[0][k] + shares[1][k] for k in range(2)]
    agreed = shares[0][0] + shares[1][1]
    by_chance = sum(a * b for a, b in zip(first, second, strict=True))
    if by_chance == 1:
        return Kappa(kappa=None, low=None, high=None, agreed=agreed, count=count)
    kappa = (agreed - by_chance) / (1 - by_chance)
    on = sum(shares[k][k] * (1 - (first[k] + second[k]) * (1 - kappa)) ** 2 for k in range(2))
    off = sum(shares[a][b] * (second[a] + first[b]) ** 2 * (1 - kappa) ** 2 for a, b in ((0, 1), (1, 0)))
    variance = on + off - (kappa - by_chance * (1 - kappa)) ** 2
    reach = NormalDist().inv_cdf(0.5 + confidence / 2) * sqrt(max(variance, 0.0) / count) / (1 - by_chance)
    return Kappa(
        kappa=kappa, low=max(kappa - reach, -1.0), high=min(kappa + reach, 1.0), agreed=agreed, count=count
    )
