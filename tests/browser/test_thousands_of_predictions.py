"""Accepting thousands of predictions at once ends, also where the page is loaded anew in the middle of it."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest
from sqlalchemy import Connection

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.project import create_project
from tests.support.forked import forked_server

COUNT, COLUMNS, PITCH = 2000, 50, 40
WITHIN_MS = 200_000


def disc(number: int) -> list[list[float]]:
    """One of the outlines, which stand in rows."""
    angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    x, y = (number % COLUMNS + 0.5) * PITCH, (number // COLUMNS + 0.5) * PITCH
    return [np.stack([x + 16 * np.cos(angles), y + 16 * np.sin(angles)], axis=1).round(2).ravel().tolist()]


@pytest.fixture
def crowded(tmp_path: Path) -> Iterator[Server]:
    """A photo with two thousand open predictions."""
    size = (COUNT // COLUMNS * PITCH, COLUMNS * PITCH, 3)
    assert cv2.imwrite(str(tmp_path / "bed.png"), np.zeros(size, np.uint8))
    with create_project(tmp_path / "beds") as project:
        import_paths(project, [tmp_path / "bed.png"])

        def predict(connection: Connection) -> None:
            run = add_run(connection, name="r", kind="network")
            seen = [NewPrediction(visible=disc(number), score=0.9) for number in range(COUNT)]
            add_predictions(connection, run_id=run.id, image_id=1, predictions=seen)

        project.write(predict)
    server = forked_server(tmp_path / "beds")
    server.start()
    yield server
    server.stop()


def count(folder: Path, sql: str) -> int:
    with sqlite3.connect(f"file:{folder / 'project.db'}?mode=ro", uri=True) as database:
        (number,) = database.execute(sql).fetchone()
    return number


def settled(tab: Tab) -> None:
    tab.page.wait_for_function("() => window.fairyring.state.waiting === 0", timeout=WITHIN_MS)


def test_two_thousand_acceptances_are_stored_once_and_undone_in_one_step(
    crowded: Server, open_tab: Callable[..., Tab], tmp_path: Path
) -> None:
    tab, project = open_tab(crowded), tmp_path / "beds"
    tab.accept_all()
    tab.page.wait_for_function("() => window.fairyring.state.waiting < 1500", timeout=WITHIN_MS)
    tab.page.reload()
    tab.enter(crowded.url, name="Ada")
    settled(tab)
    assert count(project, "SELECT count(*) FROM annotation WHERE deleted = 0") == COUNT
    assert count(project, "SELECT count(*) FROM edit") == COUNT
    assert count(project, "SELECT count(*) FROM change_set") == 1
    tab.press("Control+z")
    tab.page.wait_for_function("() => window.fairyring.state.shapes.length === 0", timeout=WITHIN_MS)
    settled(tab)
    assert count(project, "SELECT count(*) FROM annotation WHERE deleted = 0") == 0
    assert len(tab.state("predictions")) == COUNT
