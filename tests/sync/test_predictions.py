"""Predictions that are accepted or turned down, by one person or two."""

from __future__ import annotations

import pytest
from sqlalchemy import Connection

from fairyring.storage.contents import load_predictions
from fairyring.storage.journal import Derived, commit
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.records import Cap, Edit, Prediction
from tests.support.kept import all_caps
from tests.support.two_sides import IMAGE, TwoSides, triangle


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
