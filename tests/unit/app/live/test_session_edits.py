"""Edits of a tab: answered once they are in the file, shown to others, in conflict or refused."""

from __future__ import annotations

import sqlite3
import time
from collections.abc import Sequence

import numpy as np
import pytest

from fairyring.app.live import editing
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.protocol import (
    Changed,
    Edits,
    Notice,
    Outcomes,
    Show,
    Working,
)
from fairyring.model.geometry.shapes import Circle, Polygon
from fairyring.storage.journal import Derived
from fairyring.storage.project import Project
from fairyring.storage.records import Accepted, Cap, Conflict, Edit, Refused
from tests.support.tab import Tab, new_cap
from tests.unit.app.conftest import circle


def test_others_on_the_same_image_see_an_edit_and_its_author_does_not_see_it_twice(port: int) -> None:
    with Tab(port, name="Ada", image=1) as ada, Tab(port, name="Bo", image=1) as bo:
        ada.expect(Show)
        bo.expect(Show)
        ada.edit(new_cap(1))
        seen = bo.expect(Changed)
        assert (seen.user, seen.image, [a.uid for a in seen.annotations]) == ("Ada", 1, ["cap-1"])
        assert ada.nothing_more(Changed)


def test_an_edit_is_acknowledged_only_after_it_is_in_the_file(port: int, project: Project) -> None:
    with Tab(port, name="Ada", image=1) as tab:
        tab.expect(Show)
        for number in range(5):
            outcome = tab.edit(new_cap(1, uid=f"cap-{number}", edit=f"edit-{number}")).outcomes[0]
            with sqlite3.connect(f"file:{project.folder / 'project.db'}?mode=ro", uri=True) as other:
                row = other.execute("SELECT annotation, user FROM edit WHERE id = ?", [f"edit-{number}"])
                assert row.fetchone() == (f"cap-{number}", "Ada")
            assert isinstance(outcome, Accepted)
            assert outcome.annotation.revision == 1


def test_an_edit_brings_its_centre_and_whole_outline(port: int) -> None:
    with Tab(port, image=2) as tab:
        tab.expect(Show)
        marked = new_cap(2, uid="m", edit="e1", mark=Circle(cx=41.25, cy=38.5, r=20.0))
        plain = new_cap(2, uid="p", edit="e2", visible=circle(110, 70, 25))
        by_mark, by_fit = (outcome.annotation for outcome in tab.edit(marked, plain).outcomes)
        assert by_mark.centre == (41.25, 38.5)
        assert by_mark.whole == Circle(cx=41.25, cy=38.5, r=20.0)
        assert by_fit.centre == pytest.approx((110.0, 70.0), abs=0.25)


def test_the_same_edit_again_is_accepted_again_and_stored_once(port: int, project: Project) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        first = tab.edit(new_cap(1))
        assert tab.edit(new_cap(1)) == first
    with sqlite3.connect(project.folder / "project.db") as database:
        assert database.execute("SELECT count(*) FROM edit").fetchone() == (1,)


def test_of_many_edits_those_stored_already_are_answered_before_anything_is_worked_out(
    port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[int] = []
    derive = editing._derive

    async def watched(workspace: Workspace, session: Session, edits: Sequence[Edit]) -> list[Derived]:
        asked.append(len(edits))
        return await derive(workspace, session, edits)

    monkeypatch.setattr(editing, "_derive", watched)
    many = editing.A_FEW + 2
    sent = [new_cap(1, uid=f"cap-{number}", edit=f"edit-{number}") for number in range(many)]
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        first = tab.edit(*sent[:-1])
        again = tab.edit(*sent)
    assert asked == [many - 1, 1]
    assert again.outcomes[:-1] == first.outcomes


def test_a_tab_hears_that_its_edits_are_being_stored_for_as_long_as_that_takes(
    port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(editing, "SAY_WORKING_S", 0.001)
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        tab.edit(*(new_cap(1, uid=f"cap-{number}", edit=f"edit-{number}") for number in range(40)))
        assert sum(isinstance(message, Working) for message in tab.received) >= 2


def test_a_lost_update_is_a_conflict_that_names_who_was_first(port: int) -> None:
    with Tab(port, name="Ada", image=1) as ada, Tab(port, name="Bo", image=1) as bo:
        ada.expect(Show)
        bo.expect(Show)
        ada.edit(new_cap(1))
        ada.edit(new_cap(1, edit="edit-2", base=1, doubtful=True))
        conflict = bo.edit(new_cap(1, edit="edit-3", base=1, ignored=True)).outcomes[0]
        assert isinstance(conflict, Conflict)
        assert conflict.user == "Ada"
        assert conflict.theirs.revision == 2
        assert conflict.theirs.cap.doubtful


@pytest.mark.parametrize(
    ("cap", "word"),
    [
        ({"visible": [[1.0, 1.0, 2.0, 2.0]]}, "point"),
        ({"visible": [[1e9, 0.0, 0.0, 1e9, 5.0, 5.0]]}, ""),
        ({"category": "cat"}, "categor"),
        ({"prediction": 12345}, "prediction"),
    ],
)
def test_an_edit_that_makes_no_sense_is_refused_in_a_sentence(port: int, cap: dict, word: str) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        refused, accepted = tab.edit(new_cap(1, **cap), new_cap(1, uid="good", edit="good")).outcomes
        assert isinstance(refused, Refused)
        assert word in refused.reason
        assert refused.reason.endswith(".")
        assert isinstance(accepted, Accepted)


def test_edits_that_cannot_be_read_are_refused_by_name_and_the_socket_stays_open(port: int) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        tab.editor.send('{"type":"edits","edits":[{"id":"e1","cap":{"visible":[["NaN"]]}}]}')
        refused = tab.expect(Outcomes).outcomes
        assert [(type(o), o.edit) for o in refused] == [(Refused, "e1")]
        tab.editor.send("}{")
        assert tab.expect(Notice).level == "error"
        assert isinstance(tab.edit(new_cap(1)).outcomes[0], Accepted)


def test_an_edit_of_an_image_that_is_not_there_is_refused(port: int) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        assert isinstance(tab.edit(new_cap(77)).outcomes[0], Refused)


def test_accepting_a_prediction_keeps_where_it_came_from(port: int) -> None:
    with Tab(port, image=1) as tab:
        prediction = tab.expect(Show).contents.predictions[0]
        cap = Cap(visible=prediction.visible, prediction=prediction.id)
        outcome = tab.edit(Edit(id="e", annotation="a", image=1, base=0, cap=cap)).outcomes[0]
        assert outcome.annotation.cap.prediction == prediction.id


def test_thirty_changes_in_a_row_are_all_answered_in_order(port: int) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        started = time.monotonic()
        for number in range(30):
            tab.send(Edits(edits=[new_cap(1, edit=f"e{number}", base=number)]))
        revisions = [tab.expect(Outcomes).outcomes[0].annotation.revision for _ in range(30)]
        assert revisions == list(range(1, 31))
        assert time.monotonic() - started < 10


def test_who_marks_a_cap_with_points_that_determine_nothing_is_told_so(port: int) -> None:
    angles = np.linspace(0, 0.8, 7)
    arc = np.stack([60 + 50 * np.cos(angles), 50 + 50 * np.sin(angles)], axis=1).ravel().tolist()
    with Tab(port, image=2) as tab:
        (outcome,) = tab.edit(new_cap(2, mark=Polygon(arc))).outcomes
        assert isinstance(outcome, Accepted)
        assert (outcome.annotation.cap.mark, outcome.annotation.centre) == (Polygon(arc), None)
        assert "Place a circle (C)" in tab.expect(Notice).text


def test_a_change_set_of_too_many_edits_is_refused_edit_by_edit(
    port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(editing, "MOST_EDITS", 2)
    with Tab(port, image=2) as tab:
        found = tab.edit(*(new_cap(2, uid=f"c{n}", edit=f"e{n}") for n in range(3))).outcomes
        assert [type(outcome) for outcome in found] == [Refused] * 3
        assert "at most 2 edits" in found[0].reason
        assert isinstance(tab.edit(new_cap(2)).outcomes[0], Accepted)
