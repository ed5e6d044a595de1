"""Edits of what somebody else has changed or deleted meanwhile."""

import msgspec
import pytest

from fairyring.storage.journal import commit
from fairyring.storage.records import Accepted, Cap, Conflict, Refused
from tests.support.edits import edit, journal_rows, one
from tests.support.stored import stored_annotation
from tests.unit.storage.conftest import TRIANGLE


def test_a_lost_update_is_a_conflict_that_shows_theirs_and_who(beds, cap):
    one(beds, cap=cap)
    theirs = one(beds, "e2", base=1, cap=Cap(visible=TRIANGLE), user="bob")
    mine = one(beds, "e3", base=1, cap=Cap(visible=[]), user="ann")
    assert mine == Conflict(edit="e3", theirs=theirs.annotation, user="bob")
    with beds.read() as connection:
        assert stored_annotation(connection, "cap") == theirs.annotation


@pytest.mark.parametrize("base", [0, 2, 7])
def test_any_base_but_the_current_revision_is_a_conflict(beds, cap, base):
    one(beds, cap=cap)
    assert isinstance(one(beds, "e2", base=base, cap=cap), Conflict)


def test_a_conflict_keeps_nothing_else_of_the_set_out(beds, cap):
    one(beds, cap=cap)
    outcomes = commit(
        beds,
        [
            edit("a", annotation="new", cap=cap),
            edit("b", base=0, cap=cap),
            edit("c", annotation="bad", cap=Cap(visible=[[0.0, 0.0, 1.0, 1.0]])),
            edit("d", annotation="new", base=1, cap=Cap(visible=TRIANGLE)),
        ],
        user="ann",
    )
    assert [type(outcome) for outcome in outcomes] == [Accepted, Conflict, Refused, Accepted]
    assert [row[0] for row in journal_rows(beds)] == ["e1", "a", "d"]


def test_editing_or_deleting_what_somebody_deleted_is_a_conflict(beds, cap):
    one(beds, cap=cap)
    one(beds, "e2", base=1, cap=None, user="bob")
    for number, changed in (("e3", cap), ("e4", None)):
        outcome = one(beds, number, base=1, cap=changed)
        assert isinstance(outcome, Conflict)
        assert outcome.theirs.deleted
        assert outcome.user == "bob"
    assert isinstance(one(beds, "e5", base=2, cap=None), Conflict)


def test_the_outcomes_can_be_told_apart_as_json(beds, cap):
    outcomes = commit(beds, [edit(cap=cap), edit("e2", cap=cap), edit("e3", cap=None)], user="ann")
    tags = [entry["outcome"] for entry in msgspec.json.decode(msgspec.json.encode(outcomes))]
    assert tags == ["accepted", "conflict", "conflict"]
