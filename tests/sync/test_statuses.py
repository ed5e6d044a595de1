"""A status takes the way of an edit: kept, undone, refused where somebody was quicker."""

from __future__ import annotations

from tests.support.two_sides import TwoSides, triangle


def test_a_status_given_while_the_line_is_broken_is_stored_once_it_is_up(sides: TwoSides) -> None:
    sides.cut()
    sides.say("annotated")
    assert (sides.look.status, sides.look.waiting, sides.image.status) == ("annotated", 1, "new")
    sides.reload()
    assert sides.look.status == "annotated"
    sides.drain()
    assert sides.image.status == "annotated"
    assert sides.look.waiting == 0


def test_a_status_is_undone_and_done_again_in_its_place_among_edits(sides: TwoSides) -> None:
    sides.create("u", 1)
    sides.say("annotated")
    sides.move("u", 20)
    sides.drain()
    past = [(sides.look.status, sides.look.live["u"].visible)]
    for way in ("undo", "undo", "redo", "redo"):
        sides.do(way)
        sides.drain()
        assert sides.agree
        past.append((sides.look.status, sides.look.live["u"].visible))
    assert past == [
        ("annotated", triangle(20)),
        ("annotated", triangle(1)),
        ("new", triangle(1)),
        ("annotated", triangle(1)),
        ("annotated", triangle(20)),
    ]


def test_an_edit_reopens_what_was_approved_and_its_undo_approves_it_again(sides: TwoSides) -> None:
    sides.create("u", 1)
    sides.drain()
    sides.bob_says("approved")
    sides.move("u", 20)
    assert sides.look.status == "annotated"
    sides.drain()
    assert sides.image.status == "annotated"
    sides.do("undo")
    sides.drain()
    assert sides.image.status == sides.look.status == "approved"
    sides.do("redo")
    sides.drain()
    assert sides.image.status == sides.look.status == "annotated"


def test_a_status_overtaken_by_somebody_elses_is_refused_and_shows_theirs(sides: TwoSides) -> None:
    sides.cut()
    sides.say("annotated")
    sides.bob_says("approved")
    sides.reconnect()
    sides.drain()
    assert sides.refused == ["Bob has set bed.png to “approved” meanwhile; it stays so."]
    assert sides.agree
    assert sides.image.status == "approved"
