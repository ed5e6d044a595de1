"""The runs of a project in the panel: seen, renamed, compared, exported, and named when they are made."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import urljoin

import pytest
from playwright.sync_api import expect

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server, served
from fairyring.model.geometry.shapes import Circle, fit_of_shape
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import Derived, commit
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.project import create_project
from fairyring.storage.records import Cap, Edit
from tests.support.choosing import choose
from tests.support.sighted import write_weights
from tests.unit.storage.conftest import write_noise

SQUARE = [60.0, 60.0, 120.0, 60.0, 120.0, 120.0, 60.0, 120.0]


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A photo with one marked cap at (90, 90), which two runs saw at 94 and at 92."""
    photo = write_noise(tmp_path / "bed.png", width=320, height=240)
    with create_project(tmp_path / "beds") as made:
        import_paths(made, [photo])
        cap = Cap(visible=[SQUARE], mark=Circle(90, 90, 30))
        edit = Edit(id="e", annotation="a", image=1, base=0, cap=cap)
        commit(made, [Derived(edit=edit, fit=fit_of_shape(Circle(90, 90, 30)))], user="ann")
        for name, x in (("old", 94.0), ("new", 92.0)):

            def predict(connection, name=name, x=x):
                run = add_run(connection, name=name, kind="network", weights="ab" * 32)
                said = NewPrediction(visible=[SQUARE], score=0.75, fit=fit_of_shape(Circle(x, 90, 30)))
                add_predictions(connection, run_id=run.id, image_id=1, predictions=[said])

            made.write(predict)
    write_weights(tmp_path / "beds" / "weights" / "own.safetensors")
    return tmp_path / "beds"


@pytest.fixture
def server(project: Path) -> Iterator[Server]:
    with served(project) as running:
        yield running


@pytest.fixture
def tab(server: Server, open_tab: Callable[..., Tab]) -> Tab:
    """The tab Jobs, with the runs unfolded."""
    opened = open_tab(server)
    opened.page.get_by_role("tab", name="Jobs").click()
    opened.page.get_by_text("Runs", exact=True).click()
    opened.page.locator(".fr-runs").get_by_text("new").wait_for()
    return opened


def test_a_run_is_shown_and_gets_another_name_in_list_and_head(tab: Tab) -> None:
    tab.page.locator(".fr-run").get_by_text("abababababab").wait_for()
    tab.page.get_by_label("Another name").fill("after the new lamps")
    tab.page.get_by_role("button", name="Rename this run").click()
    tab.page.locator(".fr-runs").get_by_text("after the new lamps").wait_for()
    tab.page.get_by_text("predicted by after the new lamps").wait_for()
    tab.page.reload()
    tab.page.get_by_text("predicted by after the new lamps").wait_for()


def test_two_runs_are_compared_with_what_people_marked(tab: Tab) -> None:
    choose(tab, "Compare with", "old")
    tab.page.get_by_role("button", name="Compare the two").click()
    told = tab.page.get_by_text("On 1 image.").first.inner_text()
    assert "new: mean CDR" in told
    assert "2.00 px; 1 found, 0 missed, 0 extra." in told
    assert "4.00 px; 1 found, 0 missed, 0 extra." in told
    assert "new is nearer in 1, old in 0" in told


def test_two_runs_stand_side_by_side_and_either_is_drawn_on_the_photo(tab: Tab) -> None:
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_text("Two runs side by side", exact=True).click()
    choose(tab, "First run", "old")
    tab.page.get_by_role("button", name="Compare images with these runs").click()
    both = tab.page.get_by_role("table", name="Two runs side by side")
    # 4 and 2 of 320 pixels.
    both.get_by_role("row", name="CDR % 1.250 0.625").wait_for()
    changed = tab.page.get_by_role("table", name="Caps that changed most")
    changed.get_by_role("button", name="bed.png").click()
    tab.wait_for("window.fairyring.state.review.caps[0]?.prediction.centre[0] === 92")
    choose(tab, "On the photo", "old")
    tab.wait_for("window.fairyring.state.review.caps[0].prediction.centre[0] === 94")
    assert tab.state("review.on") is True
    assert tab.state("review.caps")[0]["cdr"] == pytest.approx(1.25)
    choose(tab, "On the photo", "the latest of each image")
    tab.wait_for("window.fairyring.state.review.caps[0].prediction.centre[0] === 92")


def test_every_number_of_two_runs_leads_to_the_caps_that_it_counts_and_draws_that_run(tab: Tab) -> None:
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_text("Two runs side by side", exact=True).click()
    choose(tab, "First run", "old")
    tab.page.get_by_role("button", name="Compare images with these runs").click()
    both = tab.page.get_by_role("table", name="Two runs side by side")
    caps = tab.page.get_by_role("group", name="Caps of all images")
    for row, words in (
        ("CDR %", "1–1 of 1. CDR / floor of its mark"),
        ("matched 1 1", "1–1 of 1. Annotated and predicted"),
        ("missed 0 0", "None. Annotated, and not predicted."),
        ("extra 0 0", "None. Predicted, and not annotated."),
    ):
        both.get_by_role("row", name=row).get_by_role("button").first.click()
        caps.get_by_text("Only against old, of images compared with new, too").wait_for()
        caps.get_by_text(words).wait_for()
    both.get_by_role("row", name="Δx, px").get_by_role("button", name="4.000").click()
    worst = caps.locator(".fr-gallery button")
    # 4 of 320 pixels.
    worst.get_by_text("1.25 /").wait_for()
    worst.click()
    tab.wait_for("window.fairyring.state.review.caps[0]?.prediction.centre[0] === 94")
    expect(tab.page.get_by_role("combobox", name="On the photo", exact=True)).to_have_value("old")
    both.get_by_role("row", name="Δx, px").get_by_role("button", name="2.000").click()
    caps.get_by_text("Only against new, of images compared with old, too").wait_for()
    worst.get_by_text("0.62 /").wait_for()
    worst.click()
    tab.wait_for("window.fairyring.state.review.caps[0]?.prediction.centre[0] === 92")
    assert tab.state("selection") == ["a"]


def test_the_report_is_of_the_run_that_was_chosen_for_the_photo(tab: Tab) -> None:
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_text("Two runs side by side", exact=True).click()
    tab.page.get_by_role("button", name="Bring up to date").click()
    choose(tab, "On the photo", "old")
    link = tab.page.get_by_role("link", name="Report of this image against old")
    of_old = tab.page.request.get(urljoin(tab.page.url, link.get_attribute("href") or ""))
    of_latest = tab.page.request.get(urljoin(tab.page.url, "/review/report.html?image=1"))
    pictures = []
    for report, run, cdr in ((of_old, "old", "1.250"), (of_latest, "new", "0.625")):
        page = report.text()
        assert f"Held against the predictions of {run}." in page or f"Held against {run}." in page
        # 4 and 2 of 320 pixels.
        assert cdr in page
        pictures.append(re.findall(r'<img src="(data:[^"]+)" alt="bed.png', page))
    # Marked contours are the same in both; predicted ones, and both together, are those of the run.
    (marked_1, predicted_1, both_1), (marked_2, predicted_2, both_2) = (each[:3] for each in pictures)
    assert marked_1 == marked_2
    assert predicted_1 != predicted_2
    assert both_1 != both_2
    nothing = ("report.html?run=99", "report.html?image=99", "report.html?image=one", "caps.csv?image=99")
    for what in nothing:
        assert tab.page.request.get(urljoin(tab.page.url, f"/review/{what}")).status == 404


def test_a_run_that_later_ones_hide_is_exported(tab: Tab) -> None:
    choose(tab, "Run", "old")
    tab.page.locator(".fr-run").get_by_text("1", exact=True).wait_for()
    tab.page.get_by_role("button", name="Export this run").click()
    tab.page.get_by_text("Predictions of old (1 image).").first.wait_for()


def test_a_prediction_is_called_as_somebody_says(tab: Tab) -> None:
    tab.page.get_by_label("Name of the run").fill("by the window")
    tab.page.get_by_role("button", name="Predict this image").last.click()
    tab.page.get_by_text("predicted by by the window").wait_for()
    tab.page.locator(".fr-runs").get_by_text("by the window").wait_for()
