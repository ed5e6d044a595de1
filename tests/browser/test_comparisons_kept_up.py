"""What a reviewer sees compared follows what others do: an edit, new predictions, a run that is gone."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import expect
from sqlalchemy import Connection

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.model.geometry.shapes import Circle, fit_of_shape
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.project import open_project
from tests.support.annotated_beds import PLACES, RADIUS, make_annotated_beds, uid_of
from tests.support.choosing import choose
from tests.support.desk import selected
from tests.support.plain_bed import ring

OpenTab = Callable[..., Tab]
HOLDING_A_RUN = ("compared_class", "compared_cap", "comparison", "prediction")


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """Two photos; of the first a run called other saw two caps, and the latest one all five places."""
    path = make_annotated_beds(tmp_path, count=2)
    see(path, "other", PLACES[:2])
    see(path, "newest", PLACES)
    return path


def see(project: Path, name: str, places: tuple[tuple[int, int], ...]) -> None:
    """Adds a run with circles at these places of the first photo, as another process does."""
    said = [
        NewPrediction(visible=[ring(x, y, RADIUS)], score=0.9, fit=fit_of_shape(Circle(x, y, RADIUS)))
        for x, y in places
    ]

    def add(connection: Connection) -> None:
        run = add_run(connection, name=name, kind="network")
        add_predictions(connection, run_id=run.id, image_id=1, predictions=said)

    with open_project(project) as opened:
        opened.write(add)


def delete_run(project: Path, name: str) -> None:
    """As somebody does who works on the database itself."""
    with sqlite3.connect(project / "project.db", timeout=30) as database:
        (number,) = database.execute("SELECT id FROM run WHERE name = ?", (name,)).fetchone()
        for table in HOLDING_A_RUN:
            database.execute(f"DELETE FROM {table} WHERE run = ?", (number,))
        database.execute("DELETE FROM run WHERE id = ?", (number,))
    database.close()


def open_runs(tab: Tab) -> None:
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_text("Two runs side by side", exact=True).click()


def count_of(tab: Tab, caps: int, *, missed: int) -> None:
    """Waits until so many caps are compared, of which so many were not predicted."""
    alone = "window.fairyring.state.review.caps.filter(({prediction}) => !prediction).length"
    tab.wait_for(f"window.fairyring.state.review.caps.length === {caps} && {alone} === {missed}")


def test_what_another_person_deletes_is_compared_no_more(server: Server, open_tab: OpenTab) -> None:
    rev, ada = open_tab(server, name="Rev"), open_tab(server, name="Ada")
    rev.press(".")
    selected(rev, uid_of(1, 4))
    count_of(rev, 6, missed=1)
    ada.press(".")
    selected(ada, uid_of(1, 4))
    ada.press("Delete")
    ada.saved()
    count_of(rev, 5, missed=0)
    rev.page.get_by_text("difference").first.wait_for()


def test_predictions_that_come_meanwhile_are_compared(
    project: Path, server: Server, open_tab: OpenTab
) -> None:
    tab = open_tab(server, name="Rev")
    tab.press(".")
    count_of(tab, 6, missed=1)
    see(project, "later", PLACES[:1])
    # Five caps of Ada's, and one alone that the later run saw.
    count_of(tab, 5, missed=4)
    tab.page.locator(".fr-header").get_by_text("predicted by later").wait_for()


def test_a_run_that_is_gone_while_it_is_on_the_photo_gives_way_to_the_latest(
    project: Path, server: Server, open_tab: OpenTab
) -> None:
    tab = open_tab(server, name="Rev")
    open_runs(tab)
    choose(tab, "On the photo", "other")
    tab.press(".")
    count_of(tab, 5, missed=3)
    delete_run(project, "other")
    tab.page.get_by_text("The run other is gone: photos are compared with the latest").wait_for()
    count_of(tab, 6, missed=1)
    drawn = tab.page.get_by_role("combobox", name="On the photo", exact=True)
    expect(drawn).to_have_value("the latest of each image", timeout=30_000)
    for key, image in (("n", 2), ("p", 1)):
        tab.press(key)
        tab.wait_for(f"window.fairyring.state.image.id === {image}")
    tab.press(".")
    selected(tab, uid_of(1, 4))


def test_a_run_that_is_gone_while_it_stands_beside_another_is_chosen_no_more(
    project: Path, server: Server, open_tab: OpenTab
) -> None:
    tab = open_tab(server, name="Rev")
    open_runs(tab)
    choose(tab, "First run", "other")
    tab.page.get_by_role("button", name="Compare images with these runs").click()
    both = tab.page.get_by_role("table", name="Two runs side by side")
    both.get_by_role("columnheader", name="1 image", exact=True).wait_for()
    both.get_by_role("row", name="missed 3 1").get_by_role("button", name="3").click()
    caps = tab.page.get_by_role("group", name="Caps of all images")
    caps.get_by_text("1–3 of 3. Annotated, and not predicted.").wait_for()
    delete_run(project, "other")
    both.wait_for(state="detached")
    first = tab.page.get_by_role("combobox", name="First run", exact=True)
    expect(first).to_have_value("nothing", timeout=30_000)
    caps.get_by_text("None. Annotated, and not predicted.").wait_for()
    caps.get_by_role("button", name="Show all").click()
    choose(tab, "First run", "newest")
    tab.page.get_by_text("Choose two different runs.").wait_for()
