"""What two people do to one cap at once, and what becomes of statuses, refusals and yesterday's work."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest
from sqlalchemy import Connection

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import Derived, commit
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.project import create_project
from fairyring.storage.records import Cap, Edit
from tests.support.forked import forked_server
from tests.support.kept import journal_of, kept_cap, live_caps

SQUARE = [[100.0, 100.0, 200.0, 100.0, 200.0, 200.0, 100.0, 200.0]]
PREDICTED = [[300.0, 100.0, 400.0, 100.0, 400.0, 200.0, 300.0, 200.0]]


@pytest.fixture
def squares(tmp_path: Path) -> Path:
    """Two photos; on the first a square that somebody drew, and one predicted."""
    for name in ("bed_1.png", "bed_2.png"):
        assert cv2.imwrite(str(tmp_path / name), np.zeros((400, 640, 3), np.uint8))
    with create_project(tmp_path / "beds") as project:
        import_paths(project, [tmp_path / "bed_1.png", tmp_path / "bed_2.png"])
        drawn = Edit(id="drawn", annotation="square", image=1, base=0, cap=Cap(visible=SQUARE))
        commit(project, [Derived(edit=drawn)], user="Cy")

        def predict(connection: Connection) -> None:
            run = add_run(connection, name="r", kind="network")
            seen = [NewPrediction(visible=PREDICTED, score=0.9)]
            add_predictions(connection, run_id=run.id, image_id=1, predictions=seen)

        project.write(predict)
    return tmp_path / "beds"


@pytest.fixture
def served(squares: Path) -> Iterator[Server]:
    server = forked_server(squares)
    server.start()
    yield server
    if server.process and server.process.poll() is None:
        server.stop()


def status_of(tab: Tab) -> str:
    return tab.state("image")["status"]


def test_a_vertex_held_while_somebody_nudges_the_cap_is_a_conflict_that_shows_both(
    served: Server, open_tab: Callable[..., Tab], squares: Path
) -> None:
    ada, bob = open_tab(served, name="Ada"), open_tab(served, name="Bob")
    for tab in (ada, bob):
        tab.page.bring_to_front()
        tab.select((150.0, 150.0))
    ada.page.bring_to_front()
    ada.page.mouse.move(*ada.screen((100.0, 100.0)))
    ada.page.mouse.down()
    ada.page.mouse.move(*ada.screen((80.0, 80.0)), steps=4)
    bob.page.bring_to_front()
    for _ in range(12):
        bob.press("Shift+ArrowDown")
        bob.page.wait_for_timeout(450)
    bob.saved()
    stored = journal_of(squares, "square")[-1]
    assert (stored["revision"], stored["user"]) == (13, "Bob")
    ada.page.get_by_text("revision 13").wait_for()
    ada.page.bring_to_front()
    ada.page.mouse.up()
    ada.page.get_by_role("button", name="Keep mine").wait_for()
    assert "Bob changed this cap" in ada.page.get_by_role("alertdialog").inner_text()
    assert journal_of(squares, "square")[-1] == stored
    shown = ada.shape("square")
    assert shown is not None
    assert shown["cap"]["visible"][0][:2] == pytest.approx([80.0, 80.0], abs=0.5)
    ada.page.get_by_role("button", name="Take theirs").click()
    ada.wait_for("window.fairyring.state.shapes[0].cap.visible[0][1] === 112")
    kept = kept_cap(squares, "square")
    assert kept is not None
    assert kept["visible"][0][1] == 112.0


def test_two_who_accept_everything_at_once_get_every_cap_once(
    served: Server, open_tab: Callable[..., Tab], squares: Path
) -> None:
    ada, bob = open_tab(served, name="Ada"), open_tab(served, name="Bob")
    served.kill()
    for tab in (ada, bob):
        tab.page.bring_to_front()
        tab.wait_for("window.fairyring.state.connection !== 'online'")
        tab.accept_all()
    served.start()
    for tab in (ada, bob):
        tab.page.bring_to_front()
        tab.wait_for("window.fairyring.state.connection === 'online'")
        tab.saved()
        tab.wait_for("window.fairyring.state.shapes.length === 2")
        assert "conflict" not in tab.page.locator(".fairyring-status").inner_text()
    assert len(live_caps(squares)) == 2


def test_finishing_with_an_open_prediction_asks_first_and_is_undone_from_the_next_image(
    served: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(served)
    tab.press("Control+Enter")
    question = tab.page.get_by_role("alertdialog", name="Question")
    assert "one prediction" in question.inner_text()
    assert "one annotation" in question.inner_text()
    question.get_by_role("button", name="Go back").click()
    assert (tab.state("image")["id"], status_of(tab)) == (1, "new")
    tab.press("Control+Enter")
    tab.page.get_by_role("button", name="all the same").click()
    tab.wait_for("window.fairyring.state.image.id === 2")
    tab.press("Control+z")
    tab.wait_for("window.fairyring.state.image.id === 1 && window.fairyring.state.image.status === 'new'")
    tab.saved()


def test_a_cap_edited_on_an_approved_photo_reopens_it_for_everybody_until_that_is_undone(
    served: Server, open_tab: Callable[..., Tab]
) -> None:
    ada, bob = open_tab(served, name="Ada"), open_tab(served, name="Bob")
    bob.page.get_by_role("button", name="Approved", exact=True).click()
    bob.page.get_by_role("button", name="all the same").click()
    for key, status in ((None, "approved"), ("d", "annotated"), ("Control+z", "approved")):
        ada.page.bring_to_front()
        if key == "d":
            ada.select((150.0, 150.0))
        if key:
            ada.press(key)
            ada.saved()
        for tab in (ada, bob):
            tab.page.bring_to_front()
            tab.wait_for(f"window.fairyring.state.image.status === '{status}'")


def test_a_refused_edit_is_shown_and_leads_to_its_cap(served: Server, open_tab: Callable[..., Tab]) -> None:
    tab = open_tab(served)
    tab.select((150.0, 150.0))
    tab.press("d")
    tab.drag((150.0, 150.0), (-150.0, 150.0))
    notice = tab.page.locator(".fairyring-notice.is-error")
    notice.wait_for()
    assert "A change of a cap of this image was not stored: " in notice.inner_text()
    tab.press("Escape")
    assert tab.state("selection") == []
    notice.get_by_role("button", name="Show it").click()
    tab.wait_for("window.fairyring.state.selection[0] === 'square'")
    tab.press("Control+z")
    tab.saved()
    shape = tab.shape("square")
    assert shape is not None
    assert (shape["cap"]["doubtful"], shape["cap"]["visible"]) == (False, SQUARE)


def test_undo_goes_on_after_a_reload_and_the_history_brings_back_what_somebody_deleted(
    served: Server, open_tab: Callable[..., Tab], squares: Path
) -> None:
    ada = open_tab(served, name="Ada")
    ada.accept_all()
    ada.saved()
    ada.press("Control+a", "Delete")
    ada.saved()
    assert live_caps(squares) == []
    bob = open_tab(served, name="Bob")
    bob.page.get_by_role("tab", name="History").click()
    entry = bob.page.locator(".fr-changes li").first
    entry.get_by_text("deleted 2 caps").wait_for()
    entry.get_by_role("button", name="Bring back").click()
    bob.wait_for("window.fairyring.state.shapes.length === 2")
    bob.saved()
    assert len(live_caps(squares)) == 2
    ada.page.bring_to_front()
    ada.wait_for("window.fairyring.state.shapes.length === 2")
    ada.page.reload()
    ada.enter(served.url, name="Ada")
    ada.press("Control+z")
    ada.wait_for(
        "window.fairyring.state.shapes.length === 1 && window.fairyring.state.predictions.length === 1"
    )
    ada.saved()
    assert live_caps(squares) == ["square"]
