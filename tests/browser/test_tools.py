"""Caps are cut, joined, placed by their rim and swept away: by pointer and keys, seen on disk."""

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

LARGE, BESIDE, SMALL, BUD = ring(350, 200, 60), ring(475, 200, 62), ring(120, 120, 40), ring(120, 120, 12)
"""Between the first two lies a gap of three pixels, and the last lies on the third."""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_bed(tmp_path, [[LARGE, BESIDE, SMALL, BUD], []], discs=[(200, 300, 45)])


@pytest.fixture
def tab(server: Server, open_tab: Callable[..., Tab]) -> Tab:
    return open_tab(server)


def stored(project: Path) -> list[dict]:
    """All live caps on disk, the largest first."""
    caps = [kept_cap(project, uid) for uid in live_caps(project)]
    return sorted((cap for cap in caps if cap), key=lambda cap: -area_of_outline(cap["visible"]))


def areas(project: Path) -> list[float]:
    return [area_of_outline(cap["visible"]) for cap in stored(project)]


def on(cx: float, cy: float, r: float, degrees: float) -> Point:
    angle = math.radians(degrees)
    return cx + r * math.cos(angle), cy + r * math.sin(angle)


def test_one_stroke_across_a_cap_makes_two_of_it_and_undo_one_again(tab: Tab, project: Path) -> None:
    before = areas(project)
    tab.press("k")
    tab.drag((330, 120), (330, 170), (330, 230), (330, 280))
    tab.saved()
    half = math.acos(20 / 60)
    segment = 60**2 * half - 20 * 60 * math.sin(half)
    assert len(live_caps(project)) == 5
    assert areas(project)[3] == pytest.approx(segment, rel=0.03)
    assert sum(areas(project)) == pytest.approx(sum(before), rel=0.001)
    assert tab.state("tool") == "split"
    tab.press("Control+z")
    tab.saved()
    assert areas(project) == pytest.approx(before)


def test_selected_caps_become_one_across_a_gap_of_a_few_pixels(tab: Tab, project: Path) -> None:
    kept = tab.select((475, 200))
    tab.page.keyboard.down("Shift")
    tab.click((350, 200))
    tab.page.keyboard.up("Shift")
    tab.press("j")
    tab.saved()
    assert tab.state("selection") == [kept]
    [merged, *_] = stored(project)
    assert (merged["uid"], len(merged["visible"]), len(live_caps(project))) == (kept, 1, 3)
    assert area_of_outline(merged["visible"]) > area_of_outline([LARGE]) + area_of_outline([BESIDE])


def test_a_second_part_belongs_to_the_cap_that_was_selected(tab: Tab, project: Path) -> None:
    uid = tab.select((350, 200))
    tab.press("Shift+W")
    for corner in ((300, 330), (380, 330), (340, 380)):
        tab.click(corner)
    tab.press("Enter")
    tab.saved()
    cap = kept_cap(project, uid)
    assert cap is not None
    assert [area_of_outline([part]) for part in cap["visible"]] == [
        pytest.approx(area_of_outline([LARGE])),
        pytest.approx(2000, rel=0.03),
    ]
    assert len(live_caps(project)) == 4


def test_a_stroke_takes_from_the_neighbour_what_it_adds_beyond_the_shared_border(
    tab: Tab, project: Path
) -> None:
    tab.press("r")
    tab.drag(on(350, 200, 60, -30), (430, 170), (434, 200), (430, 230), on(350, 200, 60, 30))
    tab.saved()
    larger, smaller = areas(project)[:2]
    assert larger > area_of_outline([LARGE]) + 500
    assert smaller < area_of_outline([BESIDE]) - 300
    tab.press("Control+z")
    tab.saved()
    assert areas(project)[:2] == pytest.approx([area_of_outline([BESIDE]), area_of_outline([LARGE])])


def test_three_points_of_a_rim_are_a_circle_and_five_an_ellipse(tab: Tab, project: Path) -> None:
    tab.press("o")
    for degrees in (10, 120, 250):
        tab.click(on(560, 80, 30, degrees))
    tab.press("Enter")
    for degrees in (10, 80, 150, 220, 300):
        x, y = on(0, 0, 1, degrees)
        tab.click((250 + 50 * x, 340 + 30 * y))
    tab.press("Enter")
    tab.saved()
    marks = {cap["mark"]["kind"]: cap for cap in stored(project) if cap["mark"]}
    assert marks["circle"]["mark"]["r"] == pytest.approx(30, abs=0.8)
    assert (marks["ellipse"]["mark"]["a"], marks["ellipse"]["mark"]["b"]) == (
        pytest.approx(50, abs=1.5),
        pytest.approx(30, abs=1.5),
    )
    assert area_of_outline(marks["circle"]["visible"]) == pytest.approx(math.pi * 30**2, rel=0.06)


def test_a_circle_beside_a_neighbour_shows_what_the_neighbour_leaves(tab: Tab, project: Path) -> None:
    tab.press("c")
    tab.drag((350, 300), (400, 300))
    tab.saved()
    [cap] = [cap for cap in stored(project) if cap["mark"]]
    d, r, other = 100, 50, 60
    first = r**2 * math.acos((d**2 + r**2 - other**2) / (2 * d * r))
    second = other**2 * math.acos((d**2 + other**2 - r**2) / (2 * d * other))
    rest = math.sqrt((-d + r + other) * (d + r - other) * (d - r + other) * (d + r + other)) / 2
    assert area_of_outline(cap["visible"]) == pytest.approx(math.pi * r**2 - first - second + rest, rel=0.03)
    assert tab.state("tool") == "circle"


def test_a_loose_circle_is_drawn_to_the_rim_by_one_key(tab: Tab, project: Path) -> None:
    tab.press("c")
    tab.drag((204, 297), (254, 297))
    tab.saved()
    tab.press("t")
    tab.saved()
    tab.wait_for("window.fairyring.state.shapes.some((shape) => shape.revision === 2)")
    tab.saved()
    [cap] = [cap for cap in stored(project) if cap["mark"]]
    assert (cap["mark"]["cx"], cap["mark"]["cy"], cap["mark"]["r"]) == (
        pytest.approx(200, abs=0.7),
        pytest.approx(300, abs=0.7),
        pytest.approx(45, abs=0.7),
    )
    assert area_of_outline(cap["visible"]) == pytest.approx(math.pi * 45**2, rel=0.03)


def test_the_rim_near_a_circle_is_offered_at_once_and_taken_as_it_is_shown(tab: Tab, project: Path) -> None:
    tab.press("c")
    tab.drag((204, 297), (254, 297))
    tab.wait_for("window.fairyring.state.suggestion")
    offered = tab.state("suggestion")
    tab.saved()
    tab.press("t")
    tab.wait_for("window.fairyring.state.shapes.some((shape) => shape.revision === 2)")
    tab.saved()
    [cap] = [cap for cap in stored(project) if cap["mark"]]
    assert cap["mark"]["r"] == pytest.approx(45, abs=0.7)
    assert cap["visible"] == [pytest.approx(ring) for ring in offered["visible"]]
    assert tab.state("suggestion") is None


def test_the_rim_near_a_circle_is_shown_while_it_is_dragged(tab: Tab) -> None:
    tab.press("c")
    tab.page.mouse.move(*tab.screen((204, 297)))
    tab.page.mouse.down()
    tab.page.mouse.move(*tab.screen((254, 297)), steps=6)
    tab.wait_for("window.fairyring.state.suggestion")
    shown = tab.state("suggestion")
    assert shown["mark"]["r"] == pytest.approx(45, abs=1)
    assert area_of_outline(shown["visible"]) == pytest.approx(math.pi * 45**2, rel=0.04)
    tab.press("Escape")
    tab.page.mouse.up()
    tab.wait_for("!window.fairyring.state.suggestion")


def test_what_is_offered_goes_when_another_cap_is_selected(tab: Tab) -> None:
    tab.press("w")
    way = [on(200, 300, 49, degrees) for degrees in range(0, 361, 6)]
    tab.drag(way[0], *way[1:])
    tab.wait_for("window.fairyring.state.suggestion")
    tab.press("v")
    tab.select((350, 200))
    assert tab.state("suggestion") is None


def test_delete_takes_the_cap_under_the_pointer_and_selects_nothing(tab: Tab, project: Path) -> None:
    tab.page.mouse.move(*tab.screen((350, 200)))
    tab.page.mouse.move(*tab.screen((352, 203)))
    tab.press("Delete", "Delete")
    tab.saved()
    assert (len(live_caps(project)), tab.state("selection")) == (3, [])


def test_the_broom_deletes_what_it_runs_over_and_one_undo_brings_all_back(tab: Tab, project: Path) -> None:
    page = tab.page
    page.mouse.move(*tab.screen((350, 120)))
    page.keyboard.down("b")
    page.mouse.move(*tab.screen((350, 180)), steps=3)
    page.mouse.move(*tab.screen((475, 200)), steps=3)
    assert len(tab.state("shapes")) == 4
    page.keyboard.up("b")
    tab.saved()
    assert len(live_caps(project)) == 2
    tab.press("Control+z")
    tab.saved()
    assert len(live_caps(project)) == 4


def test_a_tool_stays_in_hand_until_another_is_taken(tab: Tab, project: Path) -> None:
    tab.press("w")
    for x in (520, 580):
        for corner in ((x, 320), (x + 30, 320), (x + 15, 350)):
            tab.click(corner)
        tab.press("Enter")
    tab.saved()
    assert (tab.state("tool"), len(live_caps(project))) == ("polygon", 6)


def test_an_outline_drawn_freehand_has_as_many_points_as_the_eye_tells_apart(tab: Tab, project: Path) -> None:
    tab.press("w")
    way = [on(560, 80, 34, degrees) for degrees in range(0, 361, 3)]
    tab.drag(way[0], *way[1:])
    tab.saved()
    newest = kept_cap(project, tab.state("selection")[0])
    assert newest is not None
    [part] = newest["visible"]
    assert 10 <= len(part) // 2 <= 40
    assert area_of_outline([part]) == pytest.approx(math.pi * 34**2, rel=0.04)


def test_a_click_again_reaches_what_lies_under_and_tab_reads_in_rows(tab: Tab) -> None:
    bud = tab.select((120, 120))
    tab.page.wait_for_timeout(600)
    tab.click((120, 120))
    under = tab.state("selection")[0]
    assert under != bud
    tab.press("Escape", "Tab")
    first = tab.state("selection")[0]
    tab.press("Tab", "Tab", "Tab")
    last = tab.shape(tab.state("selection")[0])
    assert first in (bud, under)
    assert last is not None
    assert max(last["cap"]["visible"][0][::2]) > 530


def test_a_rectangle_to_the_left_takes_what_it_touches_to_the_right_what_it_encloses(tab: Tab) -> None:
    page = tab.page
    page.keyboard.down("Shift")
    tab.drag((270, 120), (300, 250), (440, 300))
    assert len(tab.state("selection")) == 1
    page.keyboard.up("Shift")
    tab.press("Escape")
    page.keyboard.down("Shift")
    tab.drag((440, 300), (300, 250), (270, 120))
    page.keyboard.up("Shift")
    assert len(tab.state("selection")) == 2


def test_a_shape_is_copied_on_its_photo_and_all_caps_to_the_next(tab: Tab, project: Path) -> None:
    tab.select((350, 200))
    tab.press("Control+c")
    tab.page.mouse.move(*tab.screen((560, 320)))
    tab.press("Control+v")
    tab.saved()
    copy = kept_cap(project, tab.state("selection")[0])
    assert copy is not None
    assert area_of_outline(copy["visible"]) == pytest.approx(area_of_outline([LARGE]), rel=0.001)
    assert sum(copy["visible"][0][::2]) / 40 == pytest.approx(560, abs=1)
    tab.press("n")
    tab.wait_for("window.fairyring.state.image.id === 2")
    tab.press("Shift+V")
    tab.saved()
    assert len(live_caps(project)) == 10
    assert len(tab.state("selection")) == 5
    tab.press("Control+z", "p")
    said_none = "no other photo was shown before"
    tab.wait_for("window.fairyring.state.image.id === 1")
    tab.press("Shift+V")
    said(tab, said_none)


def test_arrows_move_by_a_quarter_of_a_pixel_and_with_shift_by_one(tab: Tab, project: Path) -> None:
    uid = tab.select((350, 200))
    tab.press("ArrowRight", "Shift+ArrowRight", "Shift+ArrowDown")
    tab.saved()
    cap = kept_cap(project, uid)
    assert cap is not None
    assert cap["visible"][0][:2] == pytest.approx([LARGE[0] + 1.25, LARGE[1] + 1])
