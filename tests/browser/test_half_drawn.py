"""An outline that is half drawn: taken back point by point, and there again whatever comes between."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from fairyring.app.bench.browser.tab import Point, Tab
from fairyring.app.bench.serving import Server
from tests.support.kept import kept_cap, live_caps
from tests.support.said import said

CORNERS = [(12.0, 12.0), (52.0, 10.0), (58.0, 40.0), (30.0, 55.0), (8.0, 38.0)]
OTHERS = [(90.0, 12.0), (130.0, 10.0), (136.0, 40.0), (108.0, 55.0)]


@pytest.fixture
def tab(server: Server, open_tab: Callable[..., Tab]) -> Tab:
    return open_tab(server)


def place(tab: Tab, points: Sequence[Point]) -> None:
    """Takes up the tool that draws outlines and clicks points."""
    if tab.state("tool") != "polygon":
        tab.press("w")
    for point in points:
        tab.click(point)


def sizes(tab: Tab) -> list[int]:
    """How many points each cap has, as the tab shows them."""
    return [len(shape["cap"]["visible"][0]) // 2 for shape in tab.state("shapes")]


def stored_outline(project: Path) -> list[float]:
    """The outline of the only cap on disk."""
    [uid] = live_caps(project)
    kept = kept_cap(project, uid)
    assert kept is not None
    return kept["visible"][0]


def flat(points: Sequence[Point]) -> list[float]:
    return [value for point in points for value in point]


def test_undo_takes_back_the_last_point_and_redo_places_it_again(tab: Tab) -> None:
    place(tab, OTHERS)
    tab.press("Enter")
    tab.saved()
    place(tab, CORNERS)
    tab.press("Control+z", "Control+z", "Control+y", "Enter")
    tab.saved()
    assert sizes(tab) == [4, 4]


def test_a_held_undo_takes_all_points_back_and_stops_there(tab: Tab) -> None:
    place(tab, OTHERS)
    tab.press("Enter")
    tab.saved()
    place(tab, CORNERS)
    tab.press(*["Control+z"] * 12)
    assert sizes(tab) == [4]
    tab.press(*["Control+Shift+z"] * 5, "Enter")
    tab.saved()
    assert sizes(tab) == [4, 5]


def test_closing_an_outline_leaves_what_was_taken_back_of_other_caps(tab: Tab) -> None:
    place(tab, OTHERS)
    tab.press("Enter", "d")
    tab.saved()
    tab.press("Control+z")
    tab.saved()
    place(tab, CORNERS)
    tab.press("Enter")
    tab.saved()
    tab.press("Control+y")
    tab.saved()
    assert [shape["cap"]["doubtful"] for shape in tab.state("shapes")] == [True, False]


def test_a_freehand_stroke_is_taken_back_from_its_end_and_esc_as_a_whole(tab: Tab) -> None:
    tab.press("w")
    around = [(40 + 25 * math.cos(k / 4), 40 + 25 * math.sin(k / 4)) for k in range(16)]
    tab.drag(around[0], *around[1:])
    tab.press("Control+z", "Control+z", "Escape")
    assert tab.state("shapes") == []
    tab.press("Control+z", "Enter")
    tab.saved()
    [count] = sizes(tab)
    assert count >= 8


@pytest.mark.parametrize("keys", ["v", "c", "g", "n", "PageDown"])
def test_another_tool_or_image_leaves_it_half_drawn_and_says_so(tab: Tab, project: Path, keys: str) -> None:
    place(tab, CORNERS)
    first = tab.state("image.file_name")
    tab.press(keys)
    said(tab, "stays half drawn")
    if keys in ("n", "PageDown"):
        tab.wait_for(f"window.fairyring.state.image.file_name !== {first!r}")
        tab.press("w", "Enter", "p")
        tab.wait_for(f"window.fairyring.state.image.file_name === {first!r}")
        said(tab, "is half drawn here")
    assert tab.state("shapes") == []
    tab.press("Enter")
    tab.wait_for("window.fairyring.state.shapes.length === 1")
    tab.saved()
    assert stored_outline(project) == pytest.approx(flat(CORNERS), abs=1.0)


def test_an_image_is_not_done_while_an_outline_is_half_drawn(tab: Tab) -> None:
    place(tab, CORNERS)
    name = tab.state("image.file_name")
    tab.press("Control+Enter")
    said(tab, "still half drawn")
    assert (tab.state("image.file_name"), tab.state("image.status")) == (name, "new")
    tab.press("Enter")
    tab.saved()
    assert sizes(tab) == [5]


def test_a_reload_brings_it_back(tab: Tab, project: Path) -> None:
    place(tab, CORNERS)
    tab.reload()
    said(tab, "is half drawn here")
    place(tab, [(6.0, 24.0)])
    tab.press("Enter")
    tab.saved()
    assert stored_outline(project) == pytest.approx(flat([*CORNERS, (6.0, 24.0)]), abs=1.0)
    tab.reload()
    tab.press("Enter")
    assert sizes(tab) == [6], "what was closed does not come back"


def test_a_lost_connection_leaves_it_half_drawn(server: Server, tab: Tab, project: Path) -> None:
    place(tab, CORNERS[:3])
    server.kill()
    tab.wait_for("window.fairyring.state.connection === 'offline'")
    place(tab, CORNERS[3:])
    server.start()
    tab.wait_for("window.fairyring.state.connection === 'online'")
    tab.press("Enter")
    tab.saved()
    assert stored_outline(project) == pytest.approx(flat(CORNERS), abs=1.0)


def test_a_tab_that_was_closed_leaves_it_to_the_next_one(server: Server, tab: Tab) -> None:
    place(tab, CORNERS)
    page = tab.page.context.new_page()
    other = Tab(page)
    other.enter(server.url, name="Ada")
    other.press("Enter")
    assert other.state("shapes") == [], "it is the first tab's as long as that is open"
    tab.page.close()
    other.reload()
    said(other, "is half drawn here")
    other.press("Enter")
    other.saved()
    assert sizes(other) == [5]
    assert other.errors == []


def test_a_double_click_on_the_first_point_closes_the_outline_and_moves_nothing(tab: Tab) -> None:
    place(tab, CORNERS)
    scale = tab.page.evaluate("window.fairyring.view.scale")
    tab.click(CORNERS[0], count=2)
    tab.saved()
    assert sizes(tab) == [5]
    assert tab.page.evaluate("window.fairyring.view.scale") == scale
