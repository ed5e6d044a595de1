"""What is said to a person whose outline was put right as it was stored."""

from __future__ import annotations

import pytest

from fairyring.app.live.repairs import PUT_RIGHT
from fairyring.app.protocol import Notice, Show
from fairyring.storage.records import Accepted
from tests.support.tab import Tab, new_cap
from tests.unit.app.conftest import circle

BOW_TIE = [[20.0, 20.0, 80.0, 80.0, 80.0, 20.0, 20.0, 80.0]]
SHAKEN = [[20.0, 20.0, 50.0, 20.0, 51.0, 19.0, 50.0, 19.5, 51.5, 20.5, 80.0, 20.0, 80.0, 80.0, 20.0, 80.0]]
RAN_ON = [[20.0, 20.0, 80.0, 20.0, 80.0, 80.0, 20.0, 80.0, 20.0, 18.0, 40.0, 21.5]]
OVERSHOT = [[20.0, 20.0, 80.0, 20.0, 80.0, 80.0, 20.0, 80.0, 18.0, 22.0, 30.0, 16.0]]


@pytest.mark.parametrize(
    ("visible", "sentence", "parts"),
    [(OVERSHOT, PUT_RIGHT, 1), (BOW_TIE, f"{PUT_RIGHT} It has 2 parts now.", 2)],
)
def test_an_outline_that_ran_across_itself_is_put_right_there_and_that_is_said(
    port: int, visible: list[list[float]], sentence: str, parts: int
) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        [outcome] = tab.edit(new_cap(1, visible=visible)).outcomes
        assert isinstance(outcome, Accepted)
        assert tab.expect(Notice).text == sentence
        stored = outcome.annotation.cap.visible
        assert len(stored) == parts
        # A point more for each crossing, and in each part; nothing is drawn anew.
        assert sum(map(len, stored)) // 2 <= len(visible[0]) // 2 + 2


def test_nothing_is_said_of_an_outline_that_is_stored_as_it_was_drawn_or_ends_with_the_photo(
    port: int,
) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        tab.edit(
            new_cap(1, visible=circle(60, 50, 20)), new_cap(1, uid="b", edit="e2", visible=circle(2, 50, 20))
        )
        assert tab.nothing_more(Notice)


@pytest.mark.parametrize("visible", [SHAKEN, RAN_ON])
def test_nothing_is_said_of_a_hand_that_shook_or_ran_on_a_little(
    port: int, visible: list[list[float]]
) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        [outcome] = tab.edit(new_cap(1, visible=visible)).outcomes
        assert isinstance(outcome, Accepted)
        assert outcome.annotation.cap.visible != visible
        assert tab.nothing_more(Notice)
