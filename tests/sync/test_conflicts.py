"""Two people change one cap: a tab against the real journal."""

from __future__ import annotations

import pytest

from fairyring.storage.records import Cap
from tests.support.two_sides import TwoSides, triangle


def test_a_lost_update_becomes_a_conflict_and_nothing_is_overwritten(sides: TwoSides) -> None:
    sides.create("u", 1)
    sides.drain()
    sides.bob("u", doubtful=True)
    sides.move("u", 50)
    sides.move("u", 60)
    sides.drain()
    assert sides.there["u"] == Cap(visible=triangle(1), doubtful=True)
    assert [(conflict.uid, conflict.user) for conflict in sides.look.conflicts] == [("u", "Bob")]
    assert sides.look.live["u"].visible == triangle(60)
    assert sides.look.waiting == 0


@pytest.mark.parametrize(("whose", "x", "doubtful"), [("mine", 70, False), ("theirs", 1, True)])
def test_a_conflict_ends_with_the_side_that_was_chosen(
    sides: TwoSides, whose: str, x: int, doubtful: bool
) -> None:
    sides.create("u", 1)
    sides.drain()
    sides.bob("u", doubtful=True)
    sides.move("u", 50)
    sides.drain()
    sides.move("u", 70)
    sides.do("resolve", "u", whose)
    sides.drain()
    assert sides.there["u"] == Cap(visible=triangle(x), doubtful=doubtful)
    assert sides.look.conflicts == []
    assert sides.agree


def test_a_cap_that_bob_deleted_comes_back_only_if_ada_says_so(sides: TwoSides) -> None:
    sides.create("u", 1)
    sides.drain()
    sides.bob("u", cap=None)
    sides.move("u", 50)
    sides.drain()
    assert sides.there == {}
    sides.do("resolve", "u", "mine")
    sides.drain()
    assert sides.there == {"u": Cap(visible=triangle(50))}
    assert sides.agree


def test_a_conflict_not_settled_comes_back_after_a_reload(sides: TwoSides) -> None:
    sides.create("u", 1)
    sides.drain()
    sides.bob("u", doubtful=True)
    sides.move("u", 50)
    sides.drain()
    sides.move("u", 55)
    sides.reload()
    assert sides.look.live["u"].visible == triangle(55)
    sides.drain()
    assert [conflict.uid for conflict in sides.look.conflicts] == ["u"]
    assert sides.look.live["u"].visible == triangle(55)
    assert sides.there["u"] == Cap(visible=triangle(1), doubtful=True)


def test_what_was_held_while_somebody_else_changed_the_cap_is_a_conflict_that_shows_both(
    sides: TwoSides,
) -> None:
    sides.create("u", 1)
    sides.drain()
    sides.do("hold", "u")
    for order in range(12):
        sides.bob("u", order=order)
        sides.tell_of("u")
    assert sides.annotation("u").revision == 13
    sides.do("release", Cap(visible=triangle(50)))
    [sent] = sides.look.sent
    assert sent.edits[0].base == 1
    sides.drain()
    assert sides.there["u"] == Cap(visible=triangle(1), order=11)
    assert sides.look.live["u"] == Cap(visible=triangle(50))
    assert [(conflict.uid, conflict.user) for conflict in sides.look.conflicts] == [("u", "Bob")]


def test_a_cap_deleted_while_it_was_held_is_a_conflict_too(sides: TwoSides) -> None:
    sides.create("u", 1)
    sides.drain()
    sides.do("hold", "u")
    sides.bob("u", cap=None)
    sides.tell_of("u")
    sides.do("release", Cap(visible=triangle(50)))
    sides.drain()
    assert [conflict.uid for conflict in sides.look.conflicts] == ["u"]
    assert sides.there == {}
    sides.do("resolve", "u", "mine")
    sides.drain()
    assert sides.there == {"u": Cap(visible=triangle(50))}


def test_ones_own_edit_that_is_acknowledged_during_a_drag_is_no_conflict(sides: TwoSides) -> None:
    sides.create("u", 1)
    sides.become(u=sides.replaced("u", doubtful=True))
    sides.do("hold", "u")
    sides.drain()
    sides.do("release", Cap(visible=triangle(50), doubtful=True))
    sides.drain()
    assert sides.look.conflicts == []
    assert sides.there["u"] == Cap(visible=triangle(50), doubtful=True)
    assert sides.annotation("u").revision == 3
