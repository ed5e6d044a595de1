"""Store, history and outbox of a tab against the journal: traces that somebody once fell over."""

from __future__ import annotations

import pytest
from sqlalchemy import Connection

from fairyring.storage.contents import load_predictions
from fairyring.storage.journal import history
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.records import Cap, Prediction
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
    sides.move("u", 60)
    sides.serve()
    assert sides.look.live["u"] == Cap(visible=triangle(1))
    assert sides.refused == ["The project has no category “toadstool”."]
    assert sides.look.waiting == 0
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
