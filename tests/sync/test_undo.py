"""Undo, also after a reload and of what somebody else did."""

from __future__ import annotations

from fairyring.storage.image_history import list_change_sets
from fairyring.storage.journal import Derived, commit
from fairyring.storage.records import Cap, Edit
from tests.support.two_sides import IMAGE, TwoSides, triangle


def test_undo_leaves_a_cap_alone_that_somebody_else_has_changed_since(sides: TwoSides) -> None:
    sides.create("u", 1)
    sides.create("v", 2)
    sides.drain()
    sides.move("u", 50)
    sides.drain()
    sides.bob("u", doubtful=True)
    sides.tell_of("u")
    sides.do("undo")
    sides.drain()
    assert sides.there == {"u": Cap(visible=triangle(50), doubtful=True)}
    assert sides.agree


def test_undoing_goes_on_after_a_reload_and_so_does_redoing(sides: TwoSides) -> None:
    sides.create("u", 1)
    sides.move("u", 20)
    sides.say("annotated")
    sides.drain()
    sides.reload()
    sides.create("v", 40)
    sides.drain()
    states = []
    for _ in range(5):
        sides.do("undo")
        sides.drain()
        states.append((sides.image.status, {uid: cap.visible for uid, cap in sides.there.items()}))
    assert states == [
        ("annotated", {"u": triangle(20)}),
        ("new", {"u": triangle(20)}),
        ("new", {"u": triangle(1)}),
        ("new", {}),
        ("new", {}),
    ]
    assert sides.agree
    sides.reload()
    for _ in range(5):
        sides.do("redo")
        sides.drain()
    assert {uid: cap.visible for uid, cap in sides.there.items()} == {"u": triangle(20), "v": triangle(40)}
    assert sides.image.status == "annotated"
    assert sides.agree


def test_undo_asked_of_the_journal_counts_no_longer_once_something_else_was_done(sides: TwoSides) -> None:
    sides.create("u", 1)
    sides.drain()
    sides.reload()
    sides.do("undo")
    sides.create("v", 20)
    sides.drain()
    assert {uid: cap.visible for uid, cap in sides.there.items()} == {"u": triangle(1), "v": triangle(20)}
    sides.do("undo")
    sides.drain()
    assert list(sides.there) == ["u"]


def test_undo_while_the_line_is_broken_says_that_the_journal_cannot_be_asked(sides: TwoSides) -> None:
    sides.create("u", 1)
    sides.drain()
    sides.reload()
    sides.cut()
    sides.do("undo")
    assert sides.look.stuck == "offline"
    sides.reconnect()
    sides.drain()
    assert list(sides.there) == ["u"]


def test_what_somebody_else_deleted_in_one_go_is_brought_back_from_the_history(sides: TwoSides) -> None:
    for number, uid in enumerate("uvw"):
        sides.create(uid, 10 * number)
    sides.drain()
    kept = dict(sides.there)
    gone = [
        Derived(edit=Edit(id=f"x{uid}", annotation=uid, image=IMAGE, base=1, cap=None, change_set="gone"))
        for uid in "uvw"
    ]
    commit(sides.project, gone, user="Bob")
    sides.reload()
    assert sides.there == sides.look.live == {}
    with sides.project.read() as connection:
        number = list_change_sets(connection, IMAGE).change_sets[0].number
    sides.do("take_back", IMAGE, number)
    sides.drain()
    assert sides.there == kept
    assert sides.agree
    sides.do("undo")
    sides.drain()
    assert sides.there == {}
