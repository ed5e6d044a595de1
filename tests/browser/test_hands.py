"""What a hand means: Delete over a vertex, circles and marks."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.model.geometry.shapes import area_of_outline
from tests.support.kept import kept_cap, live_caps
from tests.support.plain_bed import make_bed, ring
from tests.support.said import said

HIDDEN = ring(150, 150, 50, cut=130)
"""Its centre lies under its neighbour."""
HALF_EATEN = [30, 260, 150, 260, 150, 360, 30, 360, 30, 330, 120, 310, 30, 290]
"""No round cap looks like that."""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_bed(tmp_path, [[HIDDEN, ring(182, 150, 52), ring(400, 200, 60, count=8), HALF_EATEN]])


@pytest.fixture
def tab(server: Server, open_tab: Callable[..., Tab]) -> Tab:
    return open_tab(server)


def test_delete_at_the_place_of_a_vertex_takes_out_that_vertex_and_never_the_cap(
    tab: Tab, project: Path
) -> None:
    uid = tab.select((400, 200))
    tab.page.mouse.move(*tab.screen((460, 200)))
    tab.press("Delete", "Delete", "Backspace")
    said(tab, "move the pointer away")
    tab.saved()
    kept = kept_cap(project, uid)
    assert kept is not None
    assert len(kept["visible"][0]) == 14
    tab.page.mouse.move(*tab.screen((400, 200)))
    tab.press("Delete")
    tab.saved()
    assert uid not in live_caps(project)


def test_a_circle_around_a_selected_cap_marks_it_though_its_centre_is_hidden(tab: Tab, project: Path) -> None:
    uid = tab.select((115, 150))
    tab.press("c")
    tab.drag((150, 150), (200, 150))
    tab.saved()
    kept = kept_cap(project, uid)
    assert kept is not None
    assert kept["mark"]["r"] == pytest.approx(50, abs=1)
    assert len(live_caps(project)) == 4


def test_circles_over_buds_that_touch_are_a_cap_each(tab: Tab, project: Path) -> None:
    tab.press("c")
    for x, r in ((560, 14), (580, 6), (590, 4), (550, 9)):
        tab.drag((x, 60), (x + r, 60))
    tab.saved()
    new = [kept_cap(project, uid) for uid in live_caps(project)]
    radii = sorted(round(cap["mark"]["r"]) for cap in new if cap and cap["mark"])
    assert radii == [4, 6, 9, 14]


def test_undo_while_a_circle_is_dragged_out_is_about_that_circle(tab: Tab, project: Path) -> None:
    tab.press("c")
    tab.drag((560, 60), (574, 60))
    tab.saved()
    tab.page.mouse.move(*tab.screen((500, 330)))
    tab.page.mouse.down()
    tab.page.mouse.move(*tab.screen((520, 330)), steps=4)
    tab.press("Control+z")
    tab.page.mouse.move(*tab.screen((530, 330)), steps=4)
    tab.page.mouse.up()
    tab.saved()
    assert len(live_caps(project)) == 5
    tab.press("Control+z")
    tab.saved()
    assert len(live_caps(project)) == 4


def test_m_gives_marks_and_only_shift_m_takes_them_away(tab: Tab) -> None:
    tab.select((115, 150))
    tab.press("c")
    tab.drag((150, 150), (200, 150))
    tab.press("Escape", "v", "Control+a", "m", "m")
    tab.saved()
    kinds = sorted(shape["cap"]["mark"]["kind"] for shape in tab.state("shapes"))
    assert kinds == ["circle", "polygon", "polygon", "polygon"]
    tab.press("Shift+M")
    tab.saved()
    assert [shape["cap"]["mark"] for shape in tab.state("shapes")] == [None] * 4


def test_m_marks_a_round_cap_with_a_circle_and_another_by_its_outline(tab: Tab, project: Path) -> None:
    caption = tab.page.locator(".fairyring-caption")
    for place, said_below, kind in (
        ((205, 150), "M: mark a circle", "circle"),
        ((135, 300), "M: mark the outline", "polygon"),
    ):
        uid = tab.select(place)
        caption.filter(has_text=said_below).wait_for()
        tab.press("m")
        tab.saved()
        kept = kept_cap(project, uid)
        assert kept is not None
        assert kept["mark"]["kind"] == kind
        tab.press("Escape")


def test_an_outline_that_runs_across_itself_is_told_of_and_keeps_its_points(tab: Tab, project: Path) -> None:
    tab.press("w")
    for point in ((520, 300), (600, 300), (600, 380), (520, 380), (530, 290), (560, 310)):
        tab.click(point)
    tab.press("Enter")
    said(tab, "ran across itself and was put right there")
    tab.saved()
    newest = kept_cap(project, tab.state("selection")[0])
    assert newest is not None
    [part] = newest["visible"]
    assert len(part) // 2 <= 8
    placed = list(zip(part[::2], part[1::2], strict=True))
    for point in ((600, 300), (600, 380), (520, 380), (530, 290)):
        assert pytest.approx(point, abs=1) in placed


def test_an_outline_drawn_into_a_neighbour_ends_at_its_rim_and_undo_gives_it_back(
    tab: Tab, project: Path
) -> None:
    tab.press("w")
    for point in ((420, 180), (520, 180), (520, 220), (420, 220)):
        tab.click(point)
    tab.press("Enter")
    said(tab, "Cut at its neighbours' borders")
    tab.saved()
    [uid] = tab.state("selection")
    cut = kept_cap(project, uid)
    tab.press("Control+z")
    tab.saved()
    drawn = kept_cap(project, uid)
    assert cut is not None
    assert drawn is not None
    assert area_of_outline(drawn["visible"]) == pytest.approx(100 * 40, rel=0.01)
    assert min(cut["visible"][0][::2]) > 440
    assert area_of_outline(cut["visible"]) < 70 * 40
