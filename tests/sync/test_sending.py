"""Edits of a tab reach the journal once, in their order, whatever becomes of the line."""

from __future__ import annotations

from fairyring.storage.journal import history
from tests.support.two_sides import TwoSides, triangle


def test_an_edit_is_stored_once_however_often_it_is_sent(sides: TwoSides) -> None:
    sides.create("u")
    sides.serve(answer=False)
    sides.reconnect()
    sides.drain()
    assert sides.annotation("u").revision == 1
    assert sides.look.waiting == 0
    assert sides.agree


def test_edits_made_while_the_line_is_broken_are_sent_in_their_order(sides: TwoSides) -> None:
    sides.cut()
    sides.create("u", 1)
    sides.move("u", 20)
    sides.become(u=None)
    sides.create("v", 40)
    assert sides.look.waiting == 4
    assert sides.there == {}
    sides.reconnect()
    sides.drain()
    with sides.project.read() as connection:
        told = [entry.after and entry.after.visible for entry in history(connection, "u")]
    assert told == [triangle(1), triangle(20), None]
    assert list(sides.there) == ["v"]


def test_edits_survive_a_reload_before_they_are_sent(sides: TwoSides) -> None:
    sides.cut()
    sides.create("u", 1)
    sides.move("u", 20)
    sides.reload()
    assert sides.look.live["u"].visible == triangle(20)
    sides.drain()
    assert sides.annotation("u").revision == 2
    assert sides.agree


def test_an_outline_that_the_server_repairs_is_taken_over(sides: TwoSides) -> None:
    bow_tie = [[0.0, 0.0, 40.0, 40.0, 40.0, 0.0, 0.0, 40.0]]
    sides.create("u", 1)
    sides.become(u=sides.replaced("u", visible=bow_tie))
    assert sides.look.live["u"].visible == bow_tie
    sides.drain()
    assert sides.look.live["u"].visible != bow_tie
    assert sides.agree


def test_a_large_change_set_goes_out_in_pieces_and_is_undone_in_one_step(sides: TwoSides) -> None:
    for number in range(250):
        sides.create(f"u{number}", number / 4)
    sides.drain()
    sides.become(**dict.fromkeys(sides.look.live))
    sizes = []
    while sides.look.waiting:
        sizes.append(sides.look.waiting)
        sides.serve()
    assert sizes == [250, 150, 50]
    assert sides.there == {}
    sides.reload()
    sides.do("undo")
    sides.drain()
    assert len(sides.there) == 250
    assert sides.agree
