"""What reviewers say of images and caps is kept as a history, and nobody approves their own work."""

import sqlite3

import pytest

from fairyring.model.geometry.shapes import Circle, fit_of_shape
from fairyring.storage.contents import load_predictions
from fairyring.storage.image_history import list_change_sets
from fairyring.storage.images import ImageFilter, get_image, list_ids
from fairyring.storage.journal import commit
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.records import Cap, Refused, Rules, Says, StatusEdit, StatusStored, Verdict
from fairyring.storage.rules import rules_of, set_rules
from fairyring.storage.taken_out import put_back, take_out
from fairyring.storage.verdicts import given_back, latest_verdict, verdicts_of
from tests.support.edits import one
from tests.unit.storage.conftest import TRIANGLE


def judge(
    project, number="v1", *, says: Says = "approved", words="", annotation=None, image=1, user="rev", **more
):
    said = Verdict(id=number, image=image, annotation=annotation, says=says, words=words, **more)
    (outcome,) = commit(project, [], verdicts=[said], user=user)
    assert isinstance(outcome, Refused | StatusStored)
    return outcome


def set_to(project, number, before, after, *, user, **more):
    made = StatusEdit(id=number, image=1, before=before, after=after, **more)
    (outcome,) = commit(project, [], statuses=[made], user=user)
    assert isinstance(outcome, Refused | StatusStored)
    return outcome


def reason(outcome):
    assert isinstance(outcome, Refused)
    return outcome.reason


def status(outcome):
    assert isinstance(outcome, StatusStored)
    return outcome.status


def given(project):
    with project.read() as connection:
        return [(v.user, v.says, v.words, v.annotation, v.revision) for v in verdicts_of(connection, 1)]


def status_of(project):
    with project.read() as connection:
        return get_image(connection, 1).status


@pytest.fixture
def annotated(beds, square):
    """One image with a cap that ann drew, and of which she said that it is annotated."""
    one(beds, "e1", change_set="drawn", cap=Cap(visible=square))
    set_to(beds, "s1", "new", "annotated", user="ann")
    return beds


def test_a_verdict_on_an_image_is_kept_with_who_and_why_and_sets_its_status(annotated):
    assert judge(annotated, says="sent_back", words="The rim is off") == StatusStored(
        edit="v1", image=1, status="new"
    )
    set_to(annotated, "s2", "new", "annotated", user="ann")
    judge(annotated, "v2")
    assert given(annotated) == [
        ("rev", "sent_back", "The rim is off", None, None),
        ("rev", "approved", "", None, None),
    ]
    assert status_of(annotated) == "approved"


def test_a_verdict_on_a_cap_names_its_revision_and_leaves_the_status(annotated):
    one(annotated, "e2", base=1, cap=Cap(visible=TRIANGLE))
    judge(annotated, says="rejected", words="No cap", annotation="cap")
    assert given(annotated) == [("rev", "rejected", "No cap", "cap", 2)]
    assert status_of(annotated) == "annotated"


def test_a_verdict_sent_twice_is_given_once(annotated):
    assert judge(annotated) == judge(annotated)
    assert len(given(annotated)) == 1
    assert "Another verdict has this number" in reason(judge(annotated, says="comment", words="x"))


@pytest.mark.parametrize("says", ["rejected", "sent_back", "comment"])
def test_what_needs_words_is_refused_without_them_and_changes_nothing(annotated, says):
    assert isinstance(judge(annotated, says=says, words="  "), Refused)
    assert given(annotated) == []
    assert status_of(annotated) == "annotated"


def test_a_cap_that_is_gone_or_of_another_image_is_not_judged(annotated):
    assert "no such cap" in reason(judge(annotated, annotation="cap", image=2))
    one(annotated, "e2", base=1, cap=None)
    assert "no such cap" in reason(judge(annotated, annotation="cap"))


def test_nobody_approves_what_they_have_labelled(annotated):
    assert "You have labelled " in reason(judge(annotated, user="ann"))
    assert "You have labelled " in reason(set_to(annotated, "s2", "annotated", "approved", user="ann"))
    assert "You have drawn or changed this cap" in reason(
        judge(annotated, "v2", annotation="cap", user="ann")
    )
    assert status_of(annotated) == "annotated"


def test_before_anybody_says_annotated_all_who_changed_caps_have_labelled_it(beds, square):
    one(beds, "e1", cap=Cap(visible=square), user="ann")
    one(beds, "e2", base=1, cap=Cap(visible=TRIANGLE), user="bob")
    assert isinstance(judge(beds, user="ann"), Refused)
    assert isinstance(judge(beds, user="bob"), Refused)
    assert status(judge(beds, "v2", user="rev")) == "approved"


def predicted(project, *outlines):
    """The numbers of what a network sees on the first image."""
    run = project.write(lambda c: add_run(c, name="run", kind="network"))
    caps = [NewPrediction(visible=visible, score=0.9) for visible in outlines]
    project.write(lambda c: add_predictions(c, run_id=run.id, image_id=1, predictions=caps))
    with project.read() as connection:
        return [each.id for each in load_predictions(connection, 1)]


def labelled_by(project, mark, *, kind):
    """A triangle with this mark, in a run of its own."""

    def say(connection):
        made = add_run(connection, name="run", kind=kind)
        said = NewPrediction(visible=TRIANGLE, score=1.0, fit=fit_of_shape(mark))
        add_predictions(connection, run_id=made.id, image_id=1, predictions=[said])

    project.write(say)


def test_a_reviewer_who_takes_the_networks_outline_or_deletes_a_cap_still_approves(annotated, square):
    (number,) = predicted(annotated, TRIANGLE)
    one(annotated, "e2", base=1, cap=Cap(visible=TRIANGLE), user="rev")
    one(annotated, "e3", annotation="b", cap=Cap(visible=TRIANGLE, prediction=number), user="rev")
    one(annotated, "e4", annotation="c", cap=Cap(visible=square), user="ann")
    one(annotated, "e5", annotation="c", base=1, cap=None, user="rev")
    assert status(judge(annotated)) == "approved"


def test_a_reviewer_who_takes_a_second_annotators_cap_with_its_mark_still_approves(annotated):
    mark = Circle(70, 50, 12)
    labelled_by(annotated, mark, kind="import")
    one(annotated, "e2", base=1, cap=Cap(visible=TRIANGLE, mark=mark), user="rev")
    assert "nobody else has looked" in reason(judge(annotated, "v1"))
    labelled_by(annotated, Circle(70, 51, 12), kind="second")
    assert "nobody else has looked" in reason(judge(annotated, "v2"))
    labelled_by(annotated, mark, kind="second")
    assert status(judge(annotated, "v3")) == "approved"


def test_an_outline_of_the_network_that_had_to_be_repaired_is_still_the_networks(annotated):
    crossing = [[10.0, 10.0, 50.0, 50.0, 50.0, 10.0, 10.0, 40.0]]
    (number,) = predicted(annotated, crossing)
    taken = one(annotated, "e2", annotation="b", cap=Cap(visible=crossing, prediction=number), user="rev")
    assert taken.annotation.cap.visible != crossing
    assert status(judge(annotated)) == "approved"


def test_a_reviewer_who_draws_cannot_approve_until_somebody_else_has_looked_at_it(annotated):
    one(annotated, "e2", base=1, cap=Cap(visible=TRIANGLE), user="rev")
    assert "nobody else has looked at it since" in reason(judge(annotated))
    judge(annotated, "v2", says="sent_back", words="I have redrawn it")
    assert "nobody else has looked" in reason(judge(annotated, "v3"))
    set_to(annotated, "s2", "new", "annotated", user="ann")
    assert status(judge(annotated, "v4")) == "approved"


def test_what_a_reviewer_does_to_a_rejected_image_is_work_of_their_own(annotated):
    judge(annotated, "v1", says="rejected", words="Out of focus")
    one(annotated, "e2", base=1, cap=None, user="rev")
    assert "nobody else has looked" in reason(judge(annotated, "v2"))
    assert status(judge(annotated, "v3", user="ben")) == "approved"


def test_a_rejection_may_be_thought_better_of(annotated):
    judge(annotated, "v1", says="rejected", words="Out of focus")
    assert status(judge(annotated, "v2")) == "approved"


def test_what_was_taken_back_is_nobodys_work(beds, square):
    one(beds, "e1", cap=Cap(visible=square), user="ann")
    one(beds, "e2", base=1, cap=Cap(visible=TRIANGLE), user="rev", change_set="drawn")
    one(beds, "e3", base=2, cap=Cap(visible=square), user="rev", takes_back="drawn")
    set_to(beds, "s1", "new", "annotated", user="ann")
    assert status(judge(beds)) == "approved"


def test_images_that_were_given_back_are_told_apart_and_found(annotated):
    judge(annotated, says="rejected", words="Out of focus")
    judge(annotated, "v2", says="comment", words="Pity")
    judge(annotated, "v3", says="sent_back", words="Caps are missing", image=2)

    def found():
        with annotated.read() as connection:
            said = given_back(connection, [1, 2, 3])
            rejected = list_ids(connection, ImageFilter(given_back="rejected"))
            sent_back = list_ids(connection, ImageFilter(given_back="sent_back"))
        return said, rejected, sent_back

    assert found() == ({1: "rejected", 2: "sent_back"}, [1], [2])
    set_to(annotated, "s2", "new", "annotated", user="ann")
    assert found() == ({1: "rejected", 2: "sent_back"}, [], [2])
    judge(annotated, "v4")
    assert found() == ({2: "sent_back"}, [], [2])


def test_flags_that_a_reviewer_sets_are_no_drawing(annotated, square):
    one(annotated, "e2", base=1, cap=Cap(visible=square, doubtful=True), user="rev")
    assert status(judge(annotated)) == "approved"


def test_undoing_an_approval_makes_no_annotator_of_the_reviewer(annotated):
    set_to(annotated, "s2", "annotated", "approved", user="rev", change_set="a")
    set_to(annotated, "s3", "approved", "annotated", user="rev", change_set="b", takes_back="a")
    assert [says for _, says, *_ in given(annotated)] == ["approved", "withdrawn"]
    assert status(set_to(annotated, "s4", "annotated", "approved", user="rev")) == "approved"


def test_the_project_may_allow_to_approve_own_work(annotated):
    annotated.write(lambda connection: set_rules(connection, Rules(approve_own=True)))
    with annotated.read() as connection:
        assert rules_of(connection).approve_own
    assert status(judge(annotated, user="ann")) == "approved"


def test_setting_the_status_to_approved_is_a_verdict_and_an_edit_afterwards_reopens(annotated):
    set_to(annotated, "s2", "annotated", "approved", user="rev")
    one(annotated, "e2", base=1, cap=Cap(visible=TRIANGLE))
    assert given(annotated) == [("rev", "approved", "", None, None)]
    assert status_of(annotated) == "annotated"


def test_undoing_a_sending_back_withdraws_it(annotated):
    judge(annotated, says="sent_back", words="?", change_set="back")
    set_to(annotated, "s2", "new", "annotated", user="rev", change_set="undo", takes_back="back")
    with annotated.read() as connection:
        assert latest_verdict(connection, 1) == "withdrawn"


def test_what_somebody_said_last_of_a_cap_is_theirs_to_withdraw(annotated):
    judge(annotated, "v1", annotation="cap")
    assert "no longer" in reason(judge(annotated, "v2", says="withdrawn", annotation="cap", user="bob"))
    assert status(judge(annotated, "v3", says="withdrawn", annotation="cap")) == "annotated"
    assert "no longer" in reason(judge(annotated, "v4", says="withdrawn", annotation="cap"))
    assert [says for _, says, *_ in given(annotated)] == ["approved", "withdrawn"]


def test_a_rejection_of_what_is_to_do_anyway_can_be_withdrawn(annotated):
    judge(annotated, "v1", says="sent_back", words="The rim is off")
    judge(annotated, "v2", says="rejected", words="Too dark")
    assert status(judge(annotated, "v3", says="withdrawn")) == "new"
    with annotated.read() as connection:
        assert given_back(connection, [1]) == {}


def test_an_approval_is_not_withdrawn_without_its_status(annotated):
    judge(annotated, "v1")
    assert "by setting another status" in reason(judge(annotated, "v2", says="withdrawn"))
    assert status_of(annotated) == "approved"


def test_who_takes_a_rejection_back_has_not_labelled_the_image(annotated):
    judge(annotated, says="rejected", words="Too dark", change_set="rejected")
    set_to(annotated, "s2", "new", "annotated", user="rev", change_set="back", takes_back="rejected")
    assert status(judge(annotated, "v2")) == "approved"


def test_the_history_of_the_image_tells_of_verdicts(annotated):
    judge(annotated, says="comment", words="Look here", annotation="cap")
    with annotated.read() as connection:
        last = list_change_sets(connection, 1).change_sets[0]
    assert last.verdict is not None
    assert (last.user, last.verdict.words) == ("rev", "Look here")


@pytest.mark.parametrize("change", ["UPDATE verdict SET words = 'x'", "DELETE FROM verdict"])
def test_the_history_of_verdicts_cannot_be_rewritten(annotated, change):
    judge(annotated)
    with (
        sqlite3.connect(annotated.folder / "project.db") as connection,
        pytest.raises(sqlite3.IntegrityError, match="append-only"),
    ):
        connection.execute(change)


def test_an_image_that_is_taken_out_and_put_back_keeps_its_verdicts(annotated):
    judge(annotated, says="comment", words="Look here")
    before = given(annotated)
    taken = take_out(annotated, [1], user="ann")
    put_back(annotated, taken)
    assert given(annotated) == before
