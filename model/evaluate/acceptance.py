"""Acceptance sampling: how many images to look at before all of them are approved.

Of a lot of N images n are drawn at random without putting back and looked at; the lot passes where at most c
of them are wrong. How many of the n are wrong follows the hypergeometric distribution.
"""

from __future__ import annotations

from math import comb, floor

from fairyring.model.errors import FairyringError


def chance_of_passing(lot: int, *, wrong: int, sample: int, allowed: int) -> float:
    """The probability that at most ``allowed`` of ``sample`` images are wrong.

    Args:
        lot: how many images there are.
        wrong: how many of them are wrong.
        sample: how many are drawn.
        allowed: how many wrong ones the sample may hold.
    """
    ways = sum(
        comb(wrong, found) * comb(lot - wrong, sample - found) for found in range(min(allowed, sample) + 1)
    )
    return ways / comb(lot, sample)


def sample_size(lot: int, *, allowed: int, tolerated: float, confidence: float) -> int:
    """How many images have to be looked at.

    The least number for which a lot with more than the share ``tolerated`` of wrong images passes with a
    probability of at most ``1 - confidence``; the whole lot where no smaller number does.

    Args:
        lot: how many images there are.
        allowed: how many wrong ones the sample may hold.
        tolerated: largest share of wrong images that is put up with, between 0 and 1.
        confidence: between 0 and 1.

    Raises:
        FairyringError: a share lies outside, or ``allowed`` is negative.
    """
    if not (0 <= tolerated < 1 and 0 < confidence < 1) or allowed < 0:
        raise FairyringError("A sample needs a tolerated share and a confidence between 0 and 100 %.")
    too_many = floor(tolerated * lot + 1e-9) + 1
    if too_many > lot:
        return lot
    for size in range(allowed + 1, lot):
        if chance_of_passing(lot, wrong=too_many, sample=size, allowed=allowed) <= 1 - confidence:
            return size
    return lot
