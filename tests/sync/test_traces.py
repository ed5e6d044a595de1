"""Store, history and outbox of a tab against the journal: traces that somebody once fell over."""

from __future__ import annotations

import pytest
from sqlalchemy import Connection

from fairyring.storage.contents import load_predictions
from fairyring.storage.image_history import list_change_sets
from fairyring.storage.journal import Derived, commit, history
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.records import Cap, Edit, Prediction
from tests.support.kept import all_caps
from tests.support.two_sides import IMAGE, TwoSides, triangle


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


def test_an_outline_that_the_server_repairs_is_taken_over(sides: TwoSides) -> None:
    bow_tie = [[0.0, 0.0, 40.0, 40.0, 40.0, 0.0, 0.0, 40.0]]
    sides.create("u", 1)
    sides.become(u=sides.replaced("u", visible=bow_tie))
    assert sides.look.live["u"].visible == bow_tie
    sides.drain()
    assert sides.look.live["u"].visible != bow_tie
    assert sides.agree


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


@pytest.fixture
def prediction(sides: TwoSides) -> Prediction:
    """Of the image that Ada sees."""

    def predict(connection: Connection) -> None:
        run = add_run(connection, name="r", kind="simulated")
        new = NewPrediction(visible=triangle(3), score=0.9, uid="a")
        add_predictions(connection, run_id=run.id, image_id=IMAGE, predictions=[new])

    sides.project.write(predict)
    with sides.project.read() as connection:
        [made] = load_predictions(connection, IMAGE)
    return made


@pytest.mark.parametrize("turned_down", [False, True])
def test_undoing_an_accepted_or_rejected_prediction_sets_the_prediction_free(
    sides: TwoSides, prediction: Prediction, turned_down: bool
) -> None:
    claims = []
    for what in ("take", "undo", "redo"):
        sides.do(what, *((prediction, turned_down) if what == "take" else ()))
        sides.drain()
        [uid] = all_caps(sides.project.folder)
        stored = sides.annotation(uid)
        claims.append((stored.cap.prediction, stored.deleted))
    assert claims == [(prediction.id, turned_down), (None, True), (prediction.id, turned_down)]
    assert sides.agree


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


def bob_takes(sides: TwoSides, prediction: Prediction, **fields: object) -> None:
    """Bob makes an annotation of a prediction; Ada's tab has not heard of it yet."""
    cap = Cap(visible=prediction.visible, prediction=prediction.id, **fields)
    made = Edit(id="bob's", annotation="of bob", image=IMAGE, base=0, cap=cap)
    commit(sides.project, [Derived(edit=made)], user="Bob")


def test_two_who_accept_one_prediction_get_one_cap_and_are_not_asked(
    sides: TwoSides, prediction: Prediction
) -> None:
    bob_takes(sides, prediction)
    sides.do("take", prediction, False)
    sides.drain()
    assert list(sides.there) == ["of bob"]
    assert sides.look.conflicts == []
    assert sides.agree


def test_of_two_who_make_different_caps_of_one_prediction_one_is_asked(
    sides: TwoSides, prediction: Prediction
) -> None:
    bob_takes(sides, prediction, doubtful=True)
    sides.do("take", prediction, False)
    sides.drain()
    assert [(conflict.uid, conflict.user) for conflict in sides.look.conflicts] == [("of bob", "Bob")]
    sides.do("resolve", "of bob", "mine")
    sides.drain()
    assert sides.there == {"of bob": Cap(visible=prediction.visible, prediction=prediction.id)}
    assert sides.agree


def test_turning_down_what_somebody_has_accepted_meanwhile_is_asked_about(
    sides: TwoSides, prediction: Prediction
) -> None:
    bob_takes(sides, prediction)
    sides.do("take", prediction, True)
    sides.drain()
    assert [conflict.uid for conflict in sides.look.conflicts] == ["of bob"]
    assert list(sides.there) == ["of bob"]
    sides.do("resolve", "of bob", "theirs")
    assert sides.agree


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
