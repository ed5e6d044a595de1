"""Refits of a cap in a tab's hand: the latest question is answered, the others need not be."""

from __future__ import annotations

import pytest

from fairyring.app.protocol import (
    Fitted,
    Refit,
    Show,
)
from fairyring.storage.records import Cap
from tests.support.tab import Tab
from tests.unit.app.conftest import circle


def refit_request(seq: int, x: float) -> Refit:
    """Of a round cap around (x, 40), on an image without other caps, where every method agrees."""
    return Refit(seq=seq, image=2, annotation="cap-1", cap=Cap(visible=circle(x, 40, 20)))


def test_a_refit_answers_with_the_centre_of_the_outline_it_was_asked_about(port: int) -> None:
    with Tab(port, image=2) as tab:
        tab.expect(Show)
        tab.send(refit_request(7, 50.0))
        answer = tab.expect(Fitted)
        assert (answer.seq, answer.annotation) == (7, "cap-1")
        assert answer.fit.centre == pytest.approx((50.0, 40.0), abs=0.2)
        assert answer.note


def test_of_many_refits_the_latest_wins_and_most_are_never_computed(port: int) -> None:
    with Tab(port, image=2) as tab:
        tab.expect(Show)
        for seq in range(1, 101):
            tab.send(refit_request(seq, 40.0 + seq / 10))
        answers = []
        while not answers or answers[-1].seq != 100:
            answers.append(tab.expect(Fitted))
        assert answers[-1].fit.centre == pytest.approx((50.0, 40.0), abs=0.2)
        assert [fit.seq for fit in answers] == sorted(fit.seq for fit in answers)
        assert len(answers) < 100
        assert tab.nothing_more(Fitted)


def test_a_refit_of_an_image_no_longer_shown_is_dropped(port: int) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        tab.send(refit_request(1, 30.0))
        assert tab.nothing_more(Fitted)
