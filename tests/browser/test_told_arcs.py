"""Pieces of a rim are called what they are, by pointer, keys and panel, and the fit follows."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from tests.support.kept import journal_of, kept_cap
from tests.support.plain_bed import make_bed, ring

FLAT = ring(200, 200, 60, cut=250, count=60)
"""Cut off, by nobody that the fit could know of, so little that it takes most of the cut for rim."""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_bed(tmp_path, [[FLAT, ring(450, 200, 50)]])


def told(project: Path, uid: str) -> list[str]:
    kept = kept_cap(project, uid)
    return [] if kept is None or kept["arcs"] is None else [arc["kind"] for arc in json.loads(kept["arcs"])]


def until_told(tab: Tab, kind: str) -> None:
    """Waits until the fit knows of a piece that is called so, and all is stored."""
    tab.wait_for(f"window.fairyring.state.fit?.arcs.some((arc) => arc.told && arc.kind === '{kind}')")
    tab.saved()


def test_a_stretch_is_named_by_a_drag_changed_by_a_click_and_the_fit_follows_until_it_is_undone(
    server: Server, open_tab: Callable[..., Tab], project: Path
) -> None:
    tab = open_tab(server)
    uid = tab.select((200, 200))
    tab.wait_for("window.fairyring.state.fit?.arcs.length > 0")
    before = kept_cap(project, uid)
    tab.press("l")
    tab.page.locator(".fairyring-hint").filter(has_text="Click a piece of the rim").wait_for()
    tab.drag((250, 168), (250, 190), (250, 215), (250, 232))
    until_told(tab, "hidden")
    assert told(project, uid) == ["hidden"]
    # A click gives it the next kind, the panel any.
    tab.click((250, 200))
    until_told(tab, "border")
    assert told(project, uid) == ["border"]
    listed = tab.page.locator("[data-fairyring-arc]:has(option[selected][value=border])")
    listed.select_option("hidden")
    until_told(tab, "hidden")
    after = kept_cap(project, uid)
    assert before is not None
    assert after is not None
    assert told(project, uid) == ["hidden"]
    assert json.loads(journal_of(project, uid)[-1]["after"])["arcs"] == json.loads(after["arcs"])
    # The rim that goes on beyond the cut draws the centre to where the circle has it.
    assert before["centre_x"] < 198.5
    assert after["centre_x"] == pytest.approx(200, abs=0.5)

    tab.press("Control+z", "Control+z", "Control+z")
    tab.saved()
    undone = kept_cap(project, uid)
    assert undone is not None
    assert (undone["arcs"], undone["centre_x"]) == (None, pytest.approx(before["centre_x"], abs=0.01))
