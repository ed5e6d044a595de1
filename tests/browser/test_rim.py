"""A stretch of a rim is redrawn with one stroke, by the tool for it or by Ctrl and a drag."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from fairyring.app.bench.browser.tab import Point, Tab
from fairyring.app.bench.serving import Server
from fairyring.model.geometry.shapes import area_of_outline
from tests.support.kept import kept_cap, live_caps
from tests.support.plain_bed import make_bed, ring
from tests.support.said import said

WHOLE = math.pi * 60**2


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_bed(tmp_path, [[ring(350, 200, 60), ring(120, 120, 40)]], said=True)


@pytest.fixture
def tab(server: Server, open_tab: Callable[..., Tab]) -> Tab:
    return open_tab(server)


def arc(radius: float, *, first: float = 60, start: int = 0, end: int = 90) -> list[Point]:
    """Around the first cap, with both ends on its rim."""

    def at(degrees: float, r: float) -> Point:
        angle = math.radians(degrees)
        return 350 + r * math.cos(angle), 200 + r * math.sin(angle)

    return [at(start, first), *(at(degrees, radius) for degrees in range(start, end + 1, 6)), at(end, first)]


def stored_area(project: Path) -> float:
    [uid] = live_caps(project)
    kept = kept_cap(project, uid)
    assert kept is not None
    return area_of_outline(kept["visible"])


def test_one_stroke_adds_the_next_cuts_and_the_link_to_the_prediction_stays(tab: Tab, project: Path) -> None:
    tab.press("r")
    outside = arc(75)
    tab.drag(outside[0], *outside[1:])
    tab.saved()
    assert stored_area(project) == pytest.approx(WHOLE + math.pi / 4 * (75**2 - 60**2), rel=0.02)
    inside = arc(48, start=180, end=270)
    tab.drag(inside[0], *inside[1:])
    tab.saved()
    both = math.pi / 4 * (75**2 - 60**2 - (60**2 - 48**2))
    assert stored_area(project) == pytest.approx(WHOLE + both, rel=0.02)
    [shape] = tab.state("shapes")
    assert shape["cap"]["prediction"] is not None
    assert (tab.state("tool"), len(tab.state("predictions"))) == ("rim", 1)
    tab.press("Control+z")
    tab.saved()
    assert stored_area(project) == pytest.approx(WHOLE + math.pi / 4 * (75**2 - 60**2), rel=0.02)


def test_the_cap_on_whose_rim_a_stroke_would_begin_is_told_beforehand(tab: Tab) -> None:
    tab.press("r")
    scale = tab.page.evaluate("window.fairyring.view.scale")
    first, second = (shape["uid"] for shape in tab.state("predictions"))
    for radius, told in ((60 + 12 / scale, first), (30, first), (60 + 30 / scale, None)):
        tab.page.mouse.move(*tab.screen((350 + radius, 200)))
        tab.wait_for(f"window.fairyring.state.hovered === {'null' if told is None else repr(told)}")
    tab.page.mouse.move(*tab.screen((120, 80)))
    tab.wait_for(f"window.fairyring.state.hovered === {second!r}")


def test_ctrl_and_a_drag_cut_with_select_in_hand_and_alt_takes_the_other_side(
    tab: Tab, project: Path
) -> None:
    page = tab.page
    page.keyboard.down("Control")
    tab.drag((330, 130), (330, 160), (330, 240), (330, 270))
    page.keyboard.up("Control")
    tab.saved()
    half = math.acos(20 / 60)
    segment = 60**2 * half - 20 * 60 * math.sin(half)
    assert stored_area(project) == pytest.approx(WHOLE - segment, rel=0.02)
    tab.press("Control+z")
    tab.wait_for("window.fairyring.state.shapes.length === 0")
    tab.press("r")
    page.keyboard.down("Alt")
    tab.drag((330, 130), (330, 160), (330, 240), (330, 270))
    page.keyboard.up("Alt")
    tab.saved()
    assert stored_area(project) == pytest.approx(segment, rel=0.02)


def test_a_stroke_elsewhere_changes_nothing_and_says_so(tab: Tab, project: Path) -> None:
    tab.press("r")
    tab.drag((500, 300), (560, 300), (600, 380))
    said(tab, "begins and ends on the rim")
    assert live_caps(project) == []
