import math
import shutil
import sqlite3
from dataclasses import dataclass, field

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pycocotools import mask
from sqlalchemy import delete, exc, text, update

from model.geometry import Circle, Ellipse, Polygon
from storage import schema
from storage.documents import load_annotation, load_annotations, load_version
from storage.errors import StoreError
from storage.journal import Derived, commit, history
from storage.predictions import NewPrediction, add_predictions, add_run
from storage.project import open_project
from storage.records import Accepted, Cap, Conflict, Edit, Refused

TRIANGLE = [[40.0, 40.0, 60.0, 40.0, 50.0, 60.0]]


def edit(number="e1", *, annotation="cap", image=1, base=0, cap=None, **derived):
    return Derived(edit=Edit(id=number, annotation=annotation, image=image, base=base, cap=cap), **derived)


def one(project, *args, user="ann", **kwargs):
    (outcome,) = commit(project, [edit(*args, **kwargs)], user=user)
    return outcome


def journal_rows(project):
    with sqlite3.connect(project.folder / "project.db") as connection:
        return connection.execute(
            "SELECT id, annotation, base, revision, user FROM edit ORDER BY sequence"
        ).fetchall()


@pytest.fixture
def cap(square):
    return Cap(visible=square)


def test_an_accepted_edit_is_in_the_file(beds, cap):
    outcome = one(beds, cap=cap)
    assert isinstance(outcome, Accepted)
    assert (outcome.annotation.revision, outcome.annotation.cap, outcome.annotation.deleted) == (
        1,
        cap,
        False,
    )
    assert journal_rows(beds) == [("e1", "cap", 0, 1, "ann")]


def test_every_field_of_a_cap_is_kept(beds, square):
    beds.write(
        lambda c: add_predictions(
            c,
            run_id=add_run(c, name="r", kind="simulated").id,
            image_id=1,
            predictions=[NewPrediction(visible=square, score=0.5)],
        )
    )
    marks = (Circle(20.5, 20.25, 9.75), Ellipse(20, 20, 10, 5, 179.5), Polygon(TRIANGLE[0]))
    for number, mark in enumerate(marks):
        cap = Cap(visible=square, mark=mark, ignored=True, doubtful=True, order=-3, prediction=1)
        outcome = one(beds, f"e{number}", annotation=f"cap{number}", cap=cap)
        assert isinstance(outcome, Accepted)
        with beds.read() as connection:
            stored = load_annotation(connection, f"cap{number}")
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


def test_another_edit_under_a_number_that_was_used_is_refused(beds, cap):
    one(beds, cap=cap)
    for other in (
        edit(cap=Cap(visible=TRIANGLE)),
        edit(cap=cap, annotation="other"),
        edit(cap=cap, base=1),
        edit(cap=cap, image=2),
        edit(cap=None),
    ):
        (outcome,) = commit(beds, [other], user="ann")
        assert isinstance(outcome, Refused)
        assert "Another edit has this number" in outcome.reason
    assert len(journal_rows(beds)) == 1


def test_a_lost_update_is_a_conflict_that_shows_theirs_and_who(beds, cap):
    one(beds, cap=cap)
    theirs = one(beds, "e2", base=1, cap=Cap(visible=TRIANGLE), user="bob")
    mine = one(beds, "e3", base=1, cap=Cap(visible=[]), user="ann")
    assert mine == Conflict(edit="e3", theirs=theirs.annotation, user="bob")
    with beds.read() as connection:
        assert load_annotation(connection, "cap") == theirs.annotation


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


def test_deleting_keeps_the_annotation_out_of_sight_and_undo_brings_it_back(beds, cap):
    one(beds, cap=cap)
    deleted = one(beds, "e2", base=1, cap=None)
    assert (deleted.annotation.deleted, deleted.annotation.revision) == (True, 2)
    with beds.read() as connection:
        assert load_annotations(connection, 1) == []
    back = one(beds, "e3", base=2, cap=cap)
    assert (back.annotation.deleted, back.annotation.revision, back.annotation.cap) == (False, 3, cap)


def test_editing_or_deleting_what_somebody_deleted_is_a_conflict(beds, cap):
    one(beds, cap=cap)
    one(beds, "e2", base=1, cap=None, user="bob")
    for number, changed in (("e3", cap), ("e4", None)):
        outcome = one(beds, number, base=1, cap=changed)
        assert isinstance(outcome, Conflict)
        assert outcome.theirs.deleted
        assert outcome.user == "bob"
    assert isinstance(one(beds, "e5", base=2, cap=None), Conflict)


def test_rejecting_a_prediction_is_made_and_deleted_in_one_set(beds, cap):
    outcomes = commit(beds, [edit("a", cap=cap), edit("b", base=1, cap=None)], user="ann")
    assert [outcome.annotation.revision for outcome in outcomes] == [1, 2]
    assert outcomes[1].annotation.deleted


def test_the_journal_tells_the_whole_story(beds, cap):
    moved = Cap(visible=TRIANGLE)
    one(beds, "e1", cap=cap, user="ann")
    one(beds, "e2", base=1, cap=moved, user="bob")
    one(beds, "e3", base=2, cap=None, user="ann")
    one(beds, "e4", base=3, cap=moved, user="ann")
    with beds.read() as connection:
        entries = history(connection, "cap")
    assert [(e.id, e.revision, e.before, e.after, e.user) for e in entries] == [
        ("e1", 1, None, cap, "ann"),
        ("e2", 2, cap, moved, "bob"),
        ("e3", 3, moved, None, "ann"),
        ("e4", 4, None, moved, "ann"),
    ]
    assert [e.made_at for e in entries] == sorted(e.made_at for e in entries)
    assert entries[0].made_at.endswith("Z")


@pytest.mark.parametrize(
    ("wrong", "reason"),
    [
        ({"cap": Cap(visible=[])}, "needs a visible outline or a mark"),
        ({"cap": Cap(visible=[[0.0, 0.0, 9.0, 9.0]])}, "at least three points"),
        ({"cap": Cap(visible=[[0.0, 0.0, 9.0, math.nan, 5.0, 5.0]])}, "finite"),
        ({"cap": Cap(visible=[[0.0, 0.0, 9.0, math.inf, 5.0, 5.0]])}, "finite"),
        ({"cap": Cap(visible=[[True, 0.0, 9.0, 0.0, 5.0, 5.0]])}, "numbers"),
        ({"cap": Cap(visible=[[1.0, 1.0, 9.0, 9.0, 5.0, 5.0]])}, "no area"),
        ({"cap": Cap(visible=[[0.0, 0.0, 9e6, 0.0, 5.0, 5.0]])}, "far outside"),
        ({"cap": Cap(visible=[], mark=Circle(10, 10, -1))}, "radius"),
        ({"cap": Cap(visible=[], mark=Circle(10, math.nan, 1))}, "finite"),
        ({"cap": Cap(visible=TRIANGLE * 501)}, "at most 500 parts"),
        ({"cap": Cap(visible=TRIANGLE, category="stone")}, "no category"),
        ({"cap": Cap(visible=TRIANGLE, prediction=7)}, "prediction"),
        ({"cap": Cap(visible=TRIANGLE, prediction=10**30)}, "prediction"),
        ({"cap": Cap(visible=TRIANGLE, order=10**30)}, "overlap order"),
        ({"cap": Cap(visible=TRIANGLE), "image": 99}, "no image number 99"),
        ({"cap": Cap(visible=TRIANGLE), "image": 10**30}, "no image number 1000"),
        ({"cap": Cap(visible=TRIANGLE), "base": 1}, "no such annotation"),
        ({"cap": None}, "never made"),
        ({"cap": Cap(visible=TRIANGLE), "number": ""}, "number of an edit"),
        ({"cap": Cap(visible=TRIANGLE), "number": "x" * 201}, "number of an edit"),
        ({"cap": Cap(visible=TRIANGLE), "annotation": "a\nb"}, "number of an annotation"),
    ],
)
def test_what_cannot_be_stored_is_refused_in_a_sentence(beds, wrong, reason):
    outcome = one(beds, **wrong)
    assert isinstance(outcome, Refused)
    assert reason in outcome.reason
    assert journal_rows(beds) == []


def test_an_annotation_cannot_be_moved_to_another_image(beds, cap):
    one(beds, cap=cap)
    assert "another image" in one(beds, "e2", base=1, cap=cap, image=2).reason


def test_a_self_crossing_outline_is_stored_repaired_and_covers_the_same_pixels(beds):
    crossing = [[10.0, 10.0, 40.0, 40.0, 40.0, 10.0, 10.0, 45.0]]
    stored = one(beds, cap=Cap(visible=crossing)).annotation.cap.visible
    assert stored != crossing

    def covered(outline):
        return mask.decode(mask.merge(mask.frPyObjects(outline, 80, 100)))

    assert (covered(stored) == covered(crossing)).all()


@pytest.mark.parametrize("user", ["", "x" * 201, "a\u202eb"])
def test_a_user_needs_a_name_that_can_be_shown(beds, cap, user):
    with pytest.raises(StoreError, match="name of a user"):
        one(beds, cap=cap, user=user)


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


@pytest.mark.parametrize("statement", [delete(schema.edit), update(schema.edit).values(user="nobody")])
def test_the_journal_cannot_be_rewritten(beds, cap, statement):
    one(beds, cap=cap)
    with pytest.raises(exc.IntegrityError, match="append-only"):
        beds.write(lambda connection: connection.execute(statement))
    assert journal_rows(beds) == [("e1", "cap", 0, 1, "ann")]


@dataclass
class Remembered:
    """What the store should know of one annotation, kept the simple way."""

    revisions: list[Cap | None] = field(default_factory=list)


edits = st.builds(
    dict,
    number=st.integers(0, 14).map(str),
    annotation=st.sampled_from(["a", "b", "c"]),
    base=st.integers(0, 4),
    cap=st.none() | st.sampled_from([Cap(visible=TRIANGLE), Cap(visible=[], mark=Circle(5, 5, 3))]),
)


@settings(max_examples=25, deadline=None)
@given(sets=st.lists(st.lists(edits, max_size=4), max_size=8))
def test_any_sequence_of_edits_ends_as_a_simple_model_says(sets, project_of_three, tmp_path_factory):
    folder = shutil.copytree(project_of_three, tmp_path_factory.mktemp("model") / "beds")
    seen: dict[str, dict] = {}
    remembered = {name: Remembered() for name in "abc"}
    with open_project(folder) as project:
        for change_set in sets:
            outcomes = commit(project, [edit(**sent) for sent in change_set], user="ann")
            for sent, outcome in zip(change_set, outcomes, strict=True):
                assert type(outcome) is expected_outcome(sent, seen, remembered[sent["annotation"]])
        with project.read() as connection:
            for name, memory in remembered.items():
                stored = load_annotation(connection, name)
                assert [entry.after for entry in history(connection, name)] == memory.revisions
                if memory.revisions:
                    assert stored.revision == len(memory.revisions)
                    assert stored.deleted == (memory.revisions[-1] is None)


def expected_outcome(sent, seen, memory):
    """What should become of an edit; remembers it where it should be stored."""
    if sent["number"] in seen:
        return Accepted if seen[sent["number"]] == sent else Refused
    current = len(memory.revisions)
    if current == 0 and (sent["base"] != 0 or sent["cap"] is None):
        return Refused
    deleted = current > 0 and memory.revisions[-1] is None
    if sent["base"] != current or (deleted and sent["cap"] is None):
        return Conflict
    seen[sent["number"]] = sent
    memory.revisions.append(sent["cap"])
    return Accepted


def test_the_outcomes_can_be_told_apart_as_json(beds, cap):
    outcomes = commit(beds, [edit(cap=cap), edit("e2", cap=cap), edit("e3", cap=None)], user="ann")
    tags = [entry["outcome"] for entry in msgspec.json.decode(msgspec.json.encode(outcomes))]
    assert tags == ["accepted", "conflict", "conflict"]
