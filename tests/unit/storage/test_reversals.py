"""What it takes to take back what was done to an image."""

from fairyring.storage.journal import commit
from fairyring.storage.records import Cap, StatusEdit, Verdict
from fairyring.storage.reversals import VerdictToWithdraw, next_reversal, reversal_of
from tests.support.edits import one
from tests.support.image_changes import do, history_of
from tests.unit.storage.conftest import SQUARE, TRIANGLE

THERE, MOVED = Cap(visible=SQUARE), Cap(visible=TRIANGLE)


def last(project, *, user="ann", way="undo"):
    """What to take back next: which change set, and the caps to return to, by uid."""
    with project.read() as connection:
        found = next_reversal(connection, 1, user=user, way=way)
    return found and (found.id, {r.annotation.uid: None if r.deleted else r.cap for r in found.returns})


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


def test_what_was_said_is_withdrawn_in_its_turn_and_only_while_it_is_the_last_word(predicted):
    do(predicted, "drawn", ("a", 0, THERE))

    def judge(number, says, annotation="a", user="rev", words=""):
        said = Verdict(id=number, image=1, annotation=annotation, says=says, words=words, change_set=number)
        commit(predicted, [], verdicts=[said], user=user)

    def verdict(user="rev"):
        with predicted.read() as connection:
            found = next_reversal(connection, 1, user=user, way="undo")
        return found and found.verdict

    judge("v1", "approved")
    judge("v2", "comment", words="Is it one?")
    assert verdict() == VerdictToWithdraw(annotation="a", says="approved", words="")
    judge("v3", "withdrawn")
    assert verdict() is None
    judge("v4", "approved")
    judge("v5", "rejected", user="bob", words="No cap")
    assert verdict() is None
    assert verdict("bob") == VerdictToWithdraw(annotation="a", says="rejected", words="No cap")
    do(predicted, "gone", ("a", 1, None))
    assert verdict("bob") is None
