"""What becomes of an accepted edit: stored once, as a whole, and counted."""

import threading

import pytest
from sqlalchemy import Engine, event, text

from fairyring.model.geometry.shapes import Circle, Ellipse, Polygon
from fairyring.storage import journal
from fairyring.storage.cap_validity import check_cap
from fairyring.storage.contents import load_annotations, load_version
from fairyring.storage.journal import commit
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.records import Accepted, Cap
from tests.support.edits import edit, journal_rows, one
from tests.support.stored import stored_annotation
from tests.unit.storage.conftest import TRIANGLE


def test_an_accepted_edit_is_in_the_file(beds, cap):
    outcome = one(beds, cap=cap)
    assert isinstance(outcome, Accepted)
    assert (outcome.annotation.revision, outcome.annotation.cap, outcome.annotation.deleted) == (
        1,
        cap,
        False,
    )
    assert journal_rows(beds) == [("e1", "cap", 0, 1, "ann")]


def test_an_outline_ends_where_the_photo_does(beds):
    leaving = Cap(visible=[[90.0, 10.0, 130.0, 10.0, 130.0, 30.0, 90.0, 30.0]], mark=Circle(105, 20, 10))
    stored = one(beds, cap=leaving).annotation.cap
    (part,) = stored.visible
    assert (min(part[0::2]), max(part[0::2]), min(part[1::2]), max(part[1::2])) == (90, 100, 10, 30)
    assert stored.mark == Circle(105, 20, 10)


def test_every_field_of_a_cap_is_kept(beds, square):
    beds.write(
        lambda c: add_predictions(
            c,
            run_id=add_run(c, name="r", kind="simulated").id,
            image_id=1,
            predictions=[NewPrediction(visible=square, score=0.5) for _ in range(3)],
        )
    )
    marks = (Circle(20.5, 20.25, 9.75), Ellipse(20, 20, 10, 5, 179.5), Polygon(TRIANGLE[0]))
    for number, mark in enumerate(marks):
        cap = Cap(visible=square, mark=mark, ignored=True, doubtful=True, order=-3, prediction=number + 1)
        outcome = one(beds, f"e{number}", annotation=f"cap{number}", cap=cap)
        assert isinstance(outcome, Accepted)
        with beds.read() as connection:
            stored = stored_annotation(connection, f"cap{number}")
        assert stored == outcome.annotation
        assert stored.cap == cap


def test_what_was_derived_is_stored_with_the_edit_and_replaced_by_the_next(beds, cap):
    first = one(beds, cap=cap, whole=Circle(20, 20, 10), centre=(20.0, 20.0))
    assert (first.annotation.whole, first.annotation.centre) == (Circle(20, 20, 10), (20.0, 20.0))
    second = one(beds, "e2", base=1, cap=cap)
    assert (second.annotation.whole, second.annotation.centre) == (None, None)


def test_an_edit_sent_twice_is_stored_once(beds, cap):
    assert one(beds, cap=cap) == one(beds, cap=cap)
    assert len(journal_rows(beds)) == 1


def test_an_edit_sent_twice_in_one_change_set_is_stored_once(beds, cap):
    first, second = commit(beds, [edit(cap=cap), edit(cap=cap)], user="ann")
    assert first == second
    assert len(journal_rows(beds)) == 1


def test_an_edit_sent_again_after_others_is_accepted_with_the_annotation_as_it_is_now(beds, cap):
    one(beds, cap=cap)
    now = one(beds, "e2", base=1, cap=Cap(visible=TRIANGLE), user="bob")
    again = one(beds, cap=cap)
    assert isinstance(again, Accepted)
    assert again.annotation == now.annotation
    assert len(journal_rows(beds)) == 2


def test_deleting_keeps_the_annotation_out_of_sight_and_undo_brings_it_back(beds, cap):
    one(beds, cap=cap)
    deleted = one(beds, "e2", base=1, cap=None)
    assert (deleted.annotation.deleted, deleted.annotation.revision) == (True, 2)
    with beds.read() as connection:
        assert load_annotations(connection, 1) == []
    back = one(beds, "e3", base=2, cap=cap)
    assert (back.annotation.deleted, back.annotation.revision, back.annotation.cap) == (False, 3, cap)


def test_rejecting_a_prediction_is_made_and_deleted_in_one_set(beds, cap):
    outcomes = commit(beds, [edit("a", cap=cap), edit("b", base=1, cap=None)], user="ann")
    assert [outcome.annotation.revision for outcome in outcomes] == [1, 2]
    assert outcomes[1].annotation.deleted


def test_a_self_crossing_outline_is_stored_as_the_two_triangles_it_covers(beds):
    crossing = [[10.0, 10.0, 40.0, 40.0, 40.0, 10.0, 10.0, 45.0]]
    stored = one(beds, cap=Cap(visible=crossing)).annotation.cap.visible

    middle = (10 * 6 + 40 * 7) / 13
    triangles = [[(10, 10), (10, 45), (middle, middle)], [(middle, middle), (40, 10), (40, 40)]]
    corners = sorted(sorted(zip(part[::2], part[1::2], strict=True)) for part in stored)
    assert corners == [[pytest.approx(corner) for corner in triangle] for triangle in triangles]


def test_the_counters_of_the_image_follow(beds, cap):
    def counters():
        with beds.read() as connection:
            row = connection.execute(text("SELECT caps, ignored FROM image WHERE id = 1")).one()
            return tuple(row), load_version(connection, 1)

    (counts, version) = counters()
    assert counts == (0, 0)
    expected = [
        ((1, 0), cap),
        ((0, 1), Cap(visible=cap.visible, ignored=True)),
        ((0, 0), None),
        ((1, 0), cap),
    ]
    for base, (wanted, after) in enumerate(expected):
        one(beds, f"e{base}", base=base, cap=after)
        (counts, later) = counters()
        assert counts == wanted
        assert later > version
        version = later


def test_caps_are_checked_before_the_transaction_that_everybody_waits_for(beds, cap, monkeypatch):
    threads = []

    def check(*args, **kwargs):
        threads.append(threading.current_thread().name)
        return check_cap(*args, **kwargs)

    monkeypatch.setattr(journal, "check_cap", check)
    assert isinstance(one(beds, cap=cap), Accepted)
    assert threads == [threading.current_thread().name]


def test_an_outcome_shows_the_annotation_as_the_store_has_it(beds, cap):
    moved = Cap(visible=TRIANGLE, mark=Circle(20, 20, 5), doubtful=True, order=2)
    sets = [
        [
            edit("1", cap=cap, whole=Circle(9, 8, 7), centre=(9.0, 8.0)),
            edit("2", annotation="other", cap=cap),
        ],
        [edit("3", base=1, cap=moved), edit("4", annotation="other", base=1)],
        [edit("5", base=2), edit("6", base=3, cap=cap), edit("7", annotation="third", cap=moved)],
    ]
    for change_set in sets:
        outcomes = commit(beds, change_set, user="ann")
        last = {outcome.annotation.uid: outcome.annotation for outcome in outcomes}
        with beds.read() as connection:
            assert {uid: stored_annotation(connection, uid) for uid in last} == last


def test_many_edits_ask_the_database_no_more_often_than_a_few(beds, cap, request):
    asked, counts = [], []

    def listen(*given):
        asked.append(given[2])

    event.listen(Engine, "before_cursor_execute", listen)
    request.addfinalizer(lambda: event.remove(Engine, "before_cursor_execute", listen))
    for batch, size in enumerate((3, 300)):
        made = [edit(f"{batch} {n}", annotation=f"{batch} {n}", cap=cap) for n in range(size)]
        asked.clear()
        assert all(isinstance(outcome, Accepted) for outcome in commit(beds, made, user="ann"))
        counts.append(len(asked))
    assert counts[1] <= counts[0] < 20
