"""What was done to an image, newest first, and what it takes to take it back."""

import pytest

from fairyring.storage.image_history import list_change_sets, next_reversal, reversal_of
from fairyring.storage.journal import commit
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.records import Cap, StatusEdit
from tests.support.edits import edit, one
from tests.unit.storage.conftest import SQUARE, TRIANGLE

THERE, MOVED = Cap(visible=SQUARE), Cap(visible=TRIANGLE)


def do(project, change_set, *edits, takes_back="", user="ann"):
    """A change set of edits, each (uid, base, cap)."""
    named = {"change_set": change_set, "takes_back": takes_back}
    made = [
        edit(f"{change_set}-{n}", annotation=u, base=b, cap=c, **named) for n, (u, b, c) in enumerate(edits)
    ]
    return commit(project, made, user=user)


def history_of(project, **page):
    with project.read() as connection:
        return list_change_sets(connection, 1, **page)


def last(project, *, user="ann", way="undo"):
    """What to take back next: which change set, and the caps to return to, by uid."""
    with project.read() as connection:
        found = next_reversal(connection, 1, user=user, way=way)
    return found and (found.id, {r.annotation.uid: None if r.deleted else r.cap for r in found.returns})


def test_the_history_counts_what_became_of_caps(beds):
    do(beds, "drawn", ("a", 0, THERE), ("b", 0, THERE), ("c", 0, THERE))
    do(beds, "changed", ("a", 1, MOVED), ("b", 1, None), user="bob")
    do(beds, "back", ("b", 2, THERE))
    do(beds, "rejected", ("d", 0, THERE), ("d", 1, None))
    told = [
        (s.user, s.made, s.changed, s.deleted, s.brought_back, s.turned_down)
        for s in history_of(beds).change_sets
    ]
    assert told == [
        ("ann", 0, 0, 0, 0, 1),
        ("ann", 0, 0, 0, 1, 0),
        ("bob", 0, 1, 1, 0, 0),
        ("ann", 3, 0, 0, 0, 0),
    ]


def test_the_history_comes_in_pages(beds):
    do(beds, "s0", ("a", 0, THERE))
    for number in range(1, 25):
        do(beds, f"s{number}", ("a", number, MOVED if number % 2 else THERE))
    page = history_of(beds, offset=20, limit=10)
    assert (page.total, len(page.change_sets), page.change_sets[-1].made) == (25, 5, 1)


def test_a_change_set_stored_in_pieces_is_one_step(beds):
    do(beds, "all", ("a", 0, THERE))
    one(beds, "second", annotation="b", cap=THERE, change_set="all")
    assert [each.made for each in history_of(beds).change_sets] == [2]
    assert last(beds) == ("all", {"a": None, "b": None})


def test_undoing_goes_back_step_by_step_and_redoing_forth(beds):
    do(beds, "drawn", ("a", 0, THERE))
    do(beds, "moved", ("a", 1, MOVED))
    assert last(beds) == ("moved", {"a": THERE})
    do(beds, "u1", ("a", 2, THERE), takes_back="moved")
    assert last(beds) == ("drawn", {"a": None})
    assert last(beds, way="redo") == ("u1", {"a": MOVED})
    do(beds, "r1", ("a", 3, MOVED), takes_back="u1")
    assert last(beds) == ("r1", {"a": THERE})
    assert last(beds, way="redo") is None
    told = [(each.kind, each.taken_back) for each in history_of(beds).change_sets]
    assert told == [("redone", False), ("undone", True), ("done", True), ("done", False)]


def test_what_was_undone_can_be_done_again_until_the_same_cap_is_changed(beds):
    do(beds, "drawn", ("a", 0, THERE))
    do(beds, "moved", ("a", 1, MOVED))
    do(beds, "u1", ("a", 2, THERE), takes_back="moved")
    do(beds, "other", ("b", 0, THERE))
    assert last(beds) == ("other", {"b": None})
    assert last(beds, way="redo") == ("u1", {"a": MOVED})
    do(beds, "anew", ("a", 3, Cap(visible=SQUARE, doubtful=True)))
    assert last(beds, way="redo") is None


def test_only_ones_own_steps_are_undone_and_not_what_others_changed_since(beds):
    do(beds, "drawn", ("a", 0, THERE), ("b", 0, THERE))
    do(beds, "later", ("c", 0, THERE))
    do(beds, "of bob", ("a", 1, MOVED), ("c", 1, MOVED), user="bob")
    with beds.read() as connection:
        found = next_reversal(connection, 1, user="ann", way="undo")
    assert (found.id, [r.annotation.uid for r in found.returns], found.changed_since) == ("drawn", ["b"], 1)
    assert last(beds, user="cy") is None


def test_a_deleted_cap_and_a_whole_bulk_deletion_can_be_brought_back_by_anybody(beds):
    do(beds, "drawn", ("a", 0, THERE), ("b", 0, MOVED))
    do(beds, "gone", ("a", 1, None), ("b", 1, None), user="bob")
    number = history_of(beds).change_sets[0].number
    with beds.read() as connection:
        found = reversal_of(connection, 1, number)
        assert {r.annotation.uid: r.cap for r in found.returns} == {"a": THERE, "b": MOVED}
        assert reversal_of(connection, 2, number) is None


@pytest.fixture
def predicted(beds):
    beds.write(
        lambda c: add_predictions(
            c,
            run_id=add_run(c, name="r", kind="network").id,
            image_id=1,
            predictions=[NewPrediction(visible=SQUARE, score=0.5)],
        )
    )
    return beds


def test_a_change_that_gives_a_cap_a_predicted_outline_names_the_run(predicted):
    do(predicted, "drawn", ("a", 0, MOVED))
    do(predicted, "taken", ("a", 1, THERE))
    do(predicted, "flagged", ("a", 2, Cap(visible=SQUARE, doubtful=True)))
    told = history_of(predicted).change_sets
    assert [each.outline_of for each in told] == [None, "r", None]


def test_taking_back_a_redone_acceptance_sets_its_prediction_free_again(predicted):
    taken, free = Cap(visible=SQUARE, prediction=1), Cap(visible=SQUARE)
    do(predicted, "accepted", ("a", 0, taken))
    do(predicted, "u1", ("a", 1, free), ("a", 2, None), takes_back="accepted")
    do(predicted, "r1", ("a", 3, taken), takes_back="u1")
    with predicted.read() as connection:
        (back,) = next_reversal(connection, 1, user="ann", way="undo").returns
    assert (back.cap, back.deleted) == (free, True)


def test_a_status_is_taken_back_unless_somebody_has_said_otherwise(beds):
    said = StatusEdit(id="s", image=1, before="new", after="annotated", change_set="said")
    commit(beds, [], statuses=[said], user="ann")
    with beds.read() as connection:
        assert next_reversal(connection, 1, user="ann", way="undo").status == ("annotated", "new")
    more = StatusEdit(id="t", image=1, before="annotated", after="approved")
    commit(beds, [], statuses=[more], user="bob")
    assert last(beds) is None
