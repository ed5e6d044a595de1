"""Somebody walks through a bed: cap by cap, the doubtful ones first, and says when the photo is done."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from tests.support.kept import journal_of, kept_cap, live_caps
from tests.support.plain_bed import make_bed, ring
from tests.support.said import said

CAPS = [ring(120, 120, 40), ring(350, 200, 60), ring(560, 320, 50), ring(560, 60, 12)]
SCORES = [0.95, 0.4, 0.7, 0.85]


def progress(tab: Tab) -> str:
    return tab.page.locator("[data-fairyring-progress]").inner_text()


def until_progress(tab: Tab, text: str) -> None:
    tab.page.locator("[data-fairyring-progress]").filter(has_text=text).wait_for()


class TestPredictions:
    @pytest.fixture
    def project(self, tmp_path: Path) -> Path:
        return make_bed(tmp_path, [CAPS, []], said=True, scores=SCORES)

    @pytest.fixture
    def tab(self, server: Server, open_tab: Callable[..., Tab]) -> Tab:
        return open_tab(server)

    def test_space_says_right_and_leads_from_the_worst_to_the_best(self, tab: Tab, project: Path) -> None:
        until_progress(tab, "0 of 4")
        met = []
        tab.press("Space")
        for _ in SCORES:
            [uid] = tab.state("selection")
            met.append(next(p["score"] for p in tab.state("predictions") if p["uid"] == uid))
            tab.press("Space")
        said(tab, "Every cap that is shown is checked")
        tab.saved()
        assert met == sorted(SCORES)
        assert len(live_caps(project)) == 4
        until_progress(tab, "all 4 checked")

    def test_the_space_bar_held_and_a_drag_still_move_the_view(self, tab: Tab, project: Path) -> None:
        x, y = tab.screen((300, 300))
        tab.page.mouse.move(x, y)
        tab.page.keyboard.down("Space")
        tab.page.mouse.down()
        tab.page.mouse.move(x + 60, y, steps=4)
        tab.page.mouse.up()
        tab.page.keyboard.up("Space")
        assert tab.screen((300, 300))[0] == pytest.approx(x + 60, abs=2)
        assert (tab.state("selection"), live_caps(project)) == ([], [])

    def test_a_slider_says_how_many_predictions_are_accepted_and_accepts_those(
        self, tab: Tab, project: Path
    ) -> None:
        tab.press("Shift+A")
        dialog = tab.page.get_by_role("dialog", name="Accept predictions")
        assert "3 of 4" in dialog.inner_text()
        tab.press("Escape")
        dialog.wait_for(state="detached")
        assert tab.state("shapes") == []
        tab.press("Shift+A", *["ArrowRight"] * 6)
        dialog.get_by_text("2 of 4").wait_for()
        tab.press("Enter")
        tab.wait_for("window.fairyring.state.shapes.length === 2")
        tab.saved()
        assert len(live_caps(project)) == 2
        assert sorted(p["score"] for p in tab.state("predictions")) == [0.4, 0.7]
        tab.press("Control+z")
        tab.saved()
        assert live_caps(project) == []

    def test_what_is_left_over_is_turned_down_when_the_photo_is_done(self, tab: Tab, project: Path) -> None:
        tab.press("Space", "Space", "Control+Enter")
        question = tab.page.get_by_role("alertdialog", name="Question")
        question.get_by_role("button", name="Turn the 3 down first").click()
        tab.wait_for("window.fairyring.state.image.id === 2")
        tab.press("p")
        tab.wait_for("window.fairyring.state.image.id === 1")
        tab.saved()
        assert (tab.state("image.status"), tab.state("predictions")) == ("annotated", [])
        assert len(live_caps(project)) == 1

    def test_buds_are_ignored_by_one_key(self, tab: Tab, project: Path) -> None:
        tab.press("Shift+I")
        said(tab, "One bud is ignored")
        tab.saved()
        [uid] = live_caps(project)
        kept = kept_cap(project, uid)
        assert kept is not None
        assert kept["ignored"] == 1

    def test_an_empty_photo_has_to_be_said_to_be_empty(self, tab: Tab) -> None:
        tab.press("n")
        tab.wait_for("window.fairyring.state.image.id === 2")
        until_progress(tab, "no caps")
        tab.press("Control+Enter")
        question = tab.page.get_by_role("alertdialog", name="Question")
        assert "no cap at all" in question.inner_text()
        question.get_by_role("button", name="It is empty").click()
        tab.wait_for("window.fairyring.state.image.status === 'annotated'")


class TestImportedCaps:
    @pytest.fixture
    def project(self, tmp_path: Path) -> Path:
        return make_bed(tmp_path, [CAPS[:2], []])

    @pytest.fixture
    def tab(self, server: Server, open_tab: Callable[..., Tab]) -> Tab:
        return open_tab(server)

    def test_what_a_file_said_is_open_until_somebody_says_that_it_is_right(
        self, tab: Tab, project: Path
    ) -> None:
        until_progress(tab, "0 of 2")
        before = {uid: kept_cap(project, uid) for uid in live_caps(project)}
        tab.press("Space", "Space", "Space")
        tab.saved()
        until_progress(tab, "all 2 checked")
        for uid, cap in before.items():
            assert cap is not None
            now = kept_cap(project, uid)
            assert now is not None
            assert (now["visible"], now["edited_by"]) == (cap["visible"], "Ada")
            assert [edit["revision"] for edit in journal_of(project, uid)] == [1, 2]
        tab.reload()
        until_progress(tab, "all 2 checked")
        tab.press("Control+Enter")
        tab.wait_for("window.fairyring.state.image.id === 2")

    def test_points_are_counted_while_drawing_and_asked_for_when_done(self, tab: Tab, project: Path) -> None:
        tab.press("Space", "Space", "Space", "w")
        for corner in ((200, 300), (280, 300), (280, 380), (200, 380)):
            tab.click(corner)
        tab.press("Enter", "Control+Enter")
        tab.saved()
        assert len(live_caps(project)) == 3, "it is stored all the same"
        question = tab.page.get_by_role("alertdialog", name="Question")
        assert "one outline of fewer points" in question.inner_text()

    def test_points_of_the_cap_in_front_are_not_counted_as_drawn(self, tab: Tab, project: Path) -> None:
        known = {*live_caps(project)}
        tab.press("Space", "Space", "Space", "w")
        for angle in range(0, 360, 30):
            x, y = math.cos(math.radians(angle)), math.sin(math.radians(angle))
            tab.click((430 + 60 * x, 200 + 60 * y))
        tab.press("Enter", "Control+Enter")
        tab.saved()
        [newest] = {*live_caps(project)} - known
        cap = kept_cap(project, newest)
        assert cap is not None
        assert len(cap["visible"][0]) / 2 > 20, "with the rim of the cap in front they are enough"
        question = tab.page.get_by_role("alertdialog", name="Question")
        assert "one outline of fewer points" in question.inner_text()
