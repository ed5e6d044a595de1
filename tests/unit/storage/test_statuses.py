"""The status of an image is journalled as edits are, and follows the edits of its caps."""

import pytest
from sqlalchemy import select

from fairyring.storage.db import schema
from fairyring.storage.images import get_image
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import commit
from fairyring.storage.records import Cap, Refused, StatusEdit, StatusStored
from fairyring.storage.statuses import set_status
from tests.support.edits import one
from tests.unit.storage.conftest import TRIANGLE


def say(project, number="s1", *, before="new", after="annotated", user="ann", **more):
    made = StatusEdit(id=number, image=1, before=before, after=after, **more)
    (outcome,) = commit(project, [], statuses=[made], user=user)
    return outcome


def status_of(project):
    with project.read() as connection:
        return get_image(connection, 1).status


def journalled(project):
    with project.read() as connection:
        rows = connection.execute(select(schema.status_change).order_by(schema.status_change.c.sequence))
        return [(row.before, row.after, row.user) for row in rows]


@pytest.fixture
def approved(beds, square):
    """One image with a cap, approved."""
    one(beds, "e1", change_set="drawn", cap=Cap(visible=square))
    say(beds, after="approved", user="rev")
    return beds


def test_a_status_is_stored_once_however_often_it_is_sent(beds):
    assert say(beds) == say(beds) == StatusStored(edit="s1", image=1, status="annotated")
    assert journalled(beds) == [("new", "annotated", "ann")]


def test_a_status_made_on_one_that_is_no_longer_is_refused_and_says_whose_it_is(beds):
    say(beds, after="approved", user="bob")
    outcome = say(beds, "s2")
    assert outcome == Refused(edit="s2", reason="bob has set bed_1.png to “approved” meanwhile; it stays so.")
    assert status_of(beds) == "approved"


def test_another_status_under_a_known_number_is_refused(beds):
    say(beds)
    assert "Another edit has this number" in say(beds, before="annotated", after="approved").reason


def test_an_edit_of_a_cap_reopens_an_approved_image_in_its_own_transaction(approved):
    one(approved, "e2", change_set="moved", base=1, cap=Cap(visible=TRIANGLE), user="bob")
    assert status_of(approved) == "annotated"
    assert journalled(approved)[-1] == ("approved", "annotated", "bob")


def test_a_refused_edit_and_one_in_conflict_reopen_nothing(approved, square):
    assert one(approved, "e2", change_set="x", base=0, cap=Cap(visible=square)).theirs.revision == 1
    one(approved, "e3", change_set="y", base=1, cap=Cap(visible=square, category="toadstool"))
    assert status_of(approved) == "approved"


def test_taking_the_edit_back_approves_the_image_again(approved, square):
    one(approved, "e2", change_set="moved", base=1, cap=Cap(visible=TRIANGLE))
    one(approved, "e3", change_set="back", takes_back="moved", base=2, cap=Cap(visible=square))
    assert status_of(approved) == "approved"
    one(approved, "e4", change_set="again", takes_back="back", base=3, cap=Cap(visible=TRIANGLE))
    assert status_of(approved) == "annotated"


def test_of_two_edits_the_image_is_approved_again_only_when_both_are_taken_back(approved, square):
    one(approved, "e2", change_set="moved", base=1, cap=Cap(visible=TRIANGLE))
    one(approved, "n1", annotation="new", change_set="drawn too", cap=Cap(visible=TRIANGLE), user="bob")
    one(approved, "e3", change_set="back", takes_back="moved", base=2, cap=Cap(visible=square))
    assert status_of(approved) == "annotated"
    one(
        approved, "n2", annotation="new", change_set="b", takes_back="drawn too", base=1, cap=None, user="bob"
    )
    assert status_of(approved) == "approved"


def test_drawing_the_cap_as_it_was_by_hand_does_not_approve_the_image(approved, square):
    one(approved, "e2", change_set="moved", base=1, cap=Cap(visible=TRIANGLE))
    one(approved, "e3", change_set="moved back", base=2, cap=Cap(visible=square))
    assert status_of(approved) == "annotated"


def test_what_somebody_said_since_is_not_overruled_by_taking_back(approved, square):
    one(approved, "e2", change_set="moved", base=1, cap=Cap(visible=TRIANGLE))
    say(approved, "s2", before="annotated", after="new", user="bob")
    one(approved, "e3", change_set="back", takes_back="moved", base=2, cap=Cap(visible=square))
    assert status_of(approved) == "new"


def test_a_cap_that_an_import_adds_reopens_an_approved_image(beds, write_coco):
    beds.write(lambda connection: set_status(connection, 1, "approved", user="rev"))
    import_paths(beds, [write_coco([{"segmentation": [[5, 5, 25, 5, 25, 25]], "bbox": [5, 5, 20, 20]}])])
    assert status_of(beds) == "annotated"
