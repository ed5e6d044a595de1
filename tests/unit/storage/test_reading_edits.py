"""No question of a reviewer reads all edits of a project, which hold whole caps."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from sqlalchemy import Engine, event

from fairyring.storage.candidates import count_candidates, people
from fairyring.storage.images import get_image
from fairyring.storage.journal import commit
from fairyring.storage.project import Project
from fairyring.storage.records import Cap, StatusEdit, StatusStored, Verdict
from tests.support.edits import one

SQUARE = [[10.0, 10.0, 30.0, 10.0, 30.0, 30.0, 10.0, 30.0]]


@contextmanager
def plans() -> Iterator[list[str]]:
    """How SQLite finds what is asked of it meanwhile."""
    found: list[str] = []

    def explain(_connection: Any, cursor: Any, statement: str, parameters: Any, *_: Any) -> None:
        if statement.startswith("SELECT"):
            cursor.execute(f"EXPLAIN QUERY PLAN {statement}", parameters)
            found.extend(row[3] for row in cursor.fetchall())

    event.listen(Engine, "before_cursor_execute", explain)
    try:
        yield found
    finally:
        event.remove(Engine, "before_cursor_execute", explain)


def approve(project: Project) -> None:
    (outcome,) = commit(project, [], verdicts=[Verdict(id="v", image=1, says="approved")], user="rev")
    assert isinstance(outcome, StatusStored)


def reopen_and_take_back(project: Project) -> None:
    one(project, "e2", base=1, cap=None, change_set="gone", user="rev")
    one(project, "e3", base=2, cap=Cap(visible=SQUARE), takes_back="gone", user="rev")
    with project.read() as connection:
        assert get_image(connection, 1).status == "approved"


def choose_queue(project: Project) -> None:
    with project.read() as connection:
        assert count_candidates(connection, annotator="ann") == 1
        assert count_candidates(connection, annotator="rev") == 0
        assert people(connection) == ["ann"]


@pytest.mark.parametrize("ask", [approve, reopen_and_take_back, choose_queue])
def test_it_is_answered_without_reading_through_all_edits(
    beds: Project, ask: Callable[[Project], None]
) -> None:
    one(beds, "e1", cap=Cap(visible=SQUARE))
    commit(beds, [], statuses=[StatusEdit(id="s", image=1, before="new", after="annotated")], user="ann")
    if ask is reopen_and_take_back:
        approve(beds)
    with plans() as found:
        ask(beds)
    assert found
    assert [plan for plan in found if plan.startswith("SCAN edit")] == []
