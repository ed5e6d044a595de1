"""The queues of reviewers, and the images that wait for one."""

import pytest

from fairyring.storage.candidates import candidates, count_candidates, count_waiting, people
from fairyring.storage.journal import commit
from fairyring.storage.queues import decisions_in, end_queue, make_queue, queue_of
from fairyring.storage.records import Cap, StatusEdit, Verdict
from fairyring.storage.taken_out import take_out
from tests.support.edits import one
from tests.unit.storage.conftest import TRIANGLE


def say(project, image, before, after, *, user):
    made = StatusEdit(id=f"{image}-{after}-{user}", image=image, before=before, after=after)
    commit(project, [], statuses=[made], user=user)


def judge(project, number, image, says, words=""):
    commit(project, [], verdicts=[Verdict(id=number, image=image, says=says, words=words)], user="rev")


def read(project, query, *args, **kwargs):
    with project.read() as connection:
        return query(connection, *args, **kwargs)


def titles(project, user):
    queue = read(project, queue_of, user)
    return [] if queue is None else [queue.title]


@pytest.fixture
def annotated(beds, square):
    """Ann drew a cap on images 1 and 2 and called them annotated; Bob drew one on image 3."""
    for image in (1, 2):
        one(beds, f"e{image}", annotation=f"cap{image}", image=image, cap=Cap(visible=square))
        say(beds, image, "new", "annotated", user="ann")
    one(beds, "e3", annotation="cap3", image=3, cap=Cap(visible=square), user="bob")
    return beds


def test_what_is_annotated_waits_and_what_is_approved_does_not(annotated):
    assert [each.image for each in read(annotated, candidates)] == [1, 2]
    say(annotated, 1, "annotated", "approved", user="rev")
    assert [each.image for each in read(annotated, candidates)] == [2]
    assert [each.image for each in read(annotated, candidates, unfinished=True)] == [2, 3]
    assert [each.image for each in read(annotated, candidates, annotator="bob", unfinished=True)] == [3]
    for which in ({}, {"unfinished": True}, {"annotator": "bob", "unfinished": True}):
        assert read(annotated, count_candidates, **which) == len(read(annotated, candidates, **which))
    assert read(annotated, count_waiting) == 1
    assert read(annotated, people) == ["ann", "bob", "rev"]


def test_an_edit_after_the_approval_brings_an_image_back_as_reopened(annotated):
    say(annotated, 1, "annotated", "approved", user="rev")
    one(annotated, "again", annotation="cap1", base=1, cap=Cap(visible=TRIANGLE))
    assert {each.image: each.reopened for each in read(annotated, candidates)} == {1: True, 2: False}
    assert read(annotated, count_candidates, reopened=True) == 1


def test_a_queue_is_kept_until_it_is_ended_or_another_is_begun(annotated):
    annotated.write(lambda c: make_queue(c, "name", [2, 1], user="rev"))
    annotated.write(lambda c: make_queue(c, "most missed", [1, 2], user="rev"))
    assert titles(annotated, "rev") == ["most missed"]
    assert titles(annotated, "ann") == []
    annotated.write(lambda c: end_queue(c, user="rev"))
    assert titles(annotated, "rev") == []


def test_only_what_was_last_said_since_the_queue_was_made_counts(annotated):
    judge(annotated, "v0", 1, "approved")
    queue = annotated.write(lambda c: make_queue(c, "name", [1, 2], user="rev"))
    assert read(annotated, decisions_in, queue) == {}
    judge(annotated, "v1", 1, "comment", "hm")
    judge(annotated, "v2", 2, "approved")
    judge(annotated, "v3", 2, "rejected", "no")
    judge(annotated, "v4", 3, "approved")
    assert read(annotated, decisions_in, queue) == {2: "rejected"}


def test_an_image_that_is_taken_out_leaves_the_queue(annotated):
    annotated.write(lambda c: make_queue(c, "name", [1, 2], user="rev"))
    take_out(annotated, [1], user="ann")
    queue = read(annotated, queue_of, "rev")
    assert queue is not None
    assert queue.images == [2]
