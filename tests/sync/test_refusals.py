"""An edit that the journal refuses costs nothing else."""

from __future__ import annotations

from fairyring.storage.records import Cap
from tests.support.two_sides import TwoSides, triangle


def test_a_refused_edit_gives_way_to_what_is_stored_and_says_why(sides: TwoSides) -> None:
    sides.create("u", 1)
    sides.drain()
    sides.become(u=sides.replaced("u", category="toadstool"))
    sides.serve()
    assert sides.look.live["u"] == Cap(visible=triangle(1))
    assert sides.refused == ["The project has no category “toadstool”."]
    assert sides.look.waiting == 0
    assert sides.agree


def test_a_refused_edit_takes_neither_what_waits_behind_it_nor_what_can_be_undone_with_it(
    sides: TwoSides,
) -> None:
    sides.create("u", 1)
    sides.move("u", 30)
    sides.become(u=sides.replaced("u", category="toadstool"))
    sides.move("u", 60)
    sides.become(u=sides.replaced("u", doubtful=True))
    sides.drain()
    assert len(sides.refused) == 1
    assert sides.there["u"] == Cap(visible=triangle(60), doubtful=True)
    assert sides.agree
    for cap in (Cap(visible=triangle(60)), Cap(visible=triangle(30)), Cap(visible=triangle(1))):
        sides.do("undo")
        sides.drain()
        assert sides.there["u"] == cap
    for _ in range(3):
        sides.do("redo")
    sides.drain()
    assert sides.there["u"] == Cap(visible=triangle(60), doubtful=True)


def test_an_undo_that_is_on_its_way_when_the_edit_is_refused_leaves_the_cap_as_it_was(
    sides: TwoSides,
) -> None:
    sides.create("u", 1)
    sides.drain()
    sides.become(u=sides.replaced("u", category="toadstool"))
    sides.do("undo")
    sides.drain()
    assert sides.there["u"] == Cap(visible=triangle(1))
    assert sides.annotation("u").revision == 1
    assert sides.agree
    sides.do("undo")
    sides.drain()
    assert sides.there == {}


def test_a_cap_whose_drawing_was_refused_is_gone_unless_it_was_mended(sides: TwoSides) -> None:
    sides.do("create", "u", Cap(visible=triangle(1), category="toadstool"))
    sides.do("create", "v", Cap(visible=triangle(20), category="toadstool"))
    sides.become(v=Cap(visible=triangle(20)))
    sides.drain()
    assert sides.there == {"v": Cap(visible=triangle(20))}
    assert sides.agree


def test_one_refused_edit_of_a_change_set_does_not_keep_the_others_out(sides: TwoSides) -> None:
    for number, uid in enumerate("uvw"):
        sides.create(uid, 10 * number)
    sides.drain()
    caps = {uid: sides.replaced(uid, doubtful=True) for uid in "uvw"}
    caps["v"] = sides.replaced("v", category="toadstool")
    sides.become(**caps)
    sides.drain()
    assert {uid: cap.doubtful for uid, cap in sides.there.items()} == {"u": True, "v": False, "w": True}
    assert len(sides.refused) == 1
    assert sides.agree
