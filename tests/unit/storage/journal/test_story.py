"""The journal tells the whole story, cannot be rewritten, and ends as a simple model says."""

import shutil
from dataclasses import dataclass, field

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sqlalchemy import delete, exc, update

from fairyring.model.geometry.shapes import Circle
from fairyring.storage.contents import load_editors
from fairyring.storage.db import schema
from fairyring.storage.journal import commit, history
from fairyring.storage.project import open_project
from fairyring.storage.records import Accepted, Cap, Conflict, Refused
from tests.support.edits import edit, journal_rows, one
from tests.support.stored import stored_annotation
from tests.unit.storage.conftest import TRIANGLE


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


def authors(project):
    with project.read() as connection:
        return load_editors(connection, 1)


def test_undo_gives_a_cap_back_to_whoever_made_it_and_redo_to_whoever_changed_it(beds, square):
    marked = Cap(visible=square, mark=Circle(20, 20, 9))
    one(beds, "e1", cap=marked, user="ann")
    one(beds, "e2", base=1, cap=Cap(visible=TRIANGLE), user="rev", change_set="taken")
    assert authors(beds) == {"cap": "rev"}
    one(beds, "e3", base=2, cap=marked, user="rev", change_set="undo", takes_back="taken")
    assert authors(beds) == {"cap": "ann"}
    one(beds, "e4", base=3, cap=Cap(visible=TRIANGLE), user="rev", takes_back="undo")
    assert authors(beds) == {"cap": "rev"}
    assert [user for *_, user in journal_rows(beds)] == ["ann", "rev", "rev", "rev"]


def test_undoing_a_deletion_gives_the_cap_back_and_who_is_late_hears_who_undid_it(beds, cap):
    one(beds, "e1", cap=cap, user="ann")
    one(beds, "e2", base=1, cap=None, user="rev", change_set="gone")
    one(beds, "e3", base=2, cap=cap, user="rev", takes_back="gone")
    assert authors(beds) == {"cap": "ann"}
    late = one(beds, "e4", base=1, cap=Cap(visible=TRIANGLE), user="ann")
    assert isinstance(late, Conflict)
    assert late.user == "rev"


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


@settings(max_examples=25)
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
                stored = stored_annotation(connection, name)
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
