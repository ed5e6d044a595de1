"""The usual corrections take as many inputs as the guide says."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from fairyring.app.bench.browser.hand import Hand
from fairyring.app.bench.browser.tab import Point, Tab
from fairyring.app.bench.serving import Server
from fairyring.model.geometry.shapes import area_of_outline
from tests.support.kept import kept_cap, live_caps
from tests.support.plain_bed import make_bed, ring

GUIDE = Path(__file__).parents[2] / "docs" / "guide.md"
LARGE, BESIDE, HIDDEN = ring(350, 200, 60), ring(475, 200, 60), ring(120, 120, 50, cut=105)
BUDS = [ring(40 + 40 * nth, 370, 8) for nth in range(10)]
DISC = (560, 80, 40)
"""Bright in the photo, and no cap yet: middle and radius."""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    beds = [[LARGE, BESIDE, HIDDEN, *BUDS], []]
    return make_bed(tmp_path, beds, said=True, scores=[0.9] * 13, discs=[DISC])


@pytest.fixture
def hand(server: Server, open_tab: Callable[..., Tab]) -> Hand:
    return Hand(open_tab(server))


def on_guide(correction: str) -> int:
    """Inputs here, by the table of the guide."""
    line = re.search(rf"^\| {correction}[^|]*\|\s*(\d+)", GUIDE.read_text(encoding="utf-8"), re.MULTILINE)
    assert line is not None, correction
    return int(line[1])


def on_rim(degrees: float, radius: float = 60) -> Point:
    return 350 + radius * math.cos(math.radians(degrees)), 200 + radius * math.sin(math.radians(degrees))


def areas(project: Path) -> list[float]:
    caps = [kept_cap(project, uid) for uid in live_caps(project)]
    return sorted(area_of_outline(cap["visible"]) for cap in caps if cap is not None)


def test_a_good_image_is_accepted(hand: Hand, project: Path) -> None:
    hand.press("Shift+A", "Enter")
    hand.tab.wait_for("window.fairyring.state.predictions.length === 0")
    hand.press("Control+Enter")
    hand.tab.wait_for("window.fairyring.state.image.id === 2")
    hand.tab.saved()
    assert len(live_caps(project)) == 13
    assert hand.done.count == on_guide("accept a good image")


def test_a_vertex_is_moved(hand: Hand, project: Path) -> None:
    hand.point((350, 200))
    hand.click()
    hand.draw([on_rim(0), on_rim(0, 80)])
    hand.tab.saved()
    assert areas(project)[0] > area_of_outline([LARGE])
    assert hand.done.count == on_guide("one vertex")


@pytest.mark.parametrize(("correction", "radius"), [("a quarter of an outline", 66), ("add or cut", 45)])
def test_a_stretch_is_redrawn(hand: Hand, project: Path, correction: str, radius: float) -> None:
    bow = [on_rim(degrees, radius) for degrees in range(0, 91, 5)]
    hand.draw([on_rim(0), *bow, on_rim(90)], key="Control")
    hand.tab.saved()
    quarter = math.pi / 4 * (radius**2 - 60**2)
    assert areas(project)[0] == pytest.approx(area_of_outline([LARGE]) + quarter, rel=0.02)
    assert hand.done.count == on_guide(correction)


def test_a_missed_cap_is_a_loose_circle_drawn_to_the_rim(hand: Hand, project: Path) -> None:
    x, y, r = DISC
    hand.press("c")
    hand.draw([(x + 2, y - 2), (x + r + 5, y - 2)])
    hand.tab.wait_for("window.fairyring.state.suggestion")
    hand.press("t")
    hand.tab.wait_for("window.fairyring.state.shapes.some((shape) => shape.revision === 2)")
    hand.tab.saved()
    assert areas(project)[0] == pytest.approx(math.pi * r**2, rel=0.04)
    assert hand.done.count == on_guide("a missed cap")


def test_a_cap_is_split(hand: Hand, project: Path) -> None:
    hand.press("k")
    hand.draw([(350, 130), (350, 160), (350, 200), (350, 240), (350, 270)])
    hand.tab.saved()
    assert areas(project) == pytest.approx([area_of_outline([LARGE]) / 2] * 2, rel=0.04)
    assert hand.done.count == on_guide("split")


def test_two_caps_become_one(hand: Hand, project: Path) -> None:
    hand.point((350, 200))
    hand.click()
    hand.point((475, 200))
    hand.click(key="Shift")
    hand.press("j")
    hand.tab.saved()
    assert areas(project)[-1] > area_of_outline([LARGE]) + area_of_outline([BESIDE]) - 1
    assert hand.done.count == on_guide("merge")


def test_a_half_hidden_cap_gets_a_circle(hand: Hand, project: Path) -> None:
    hand.point((85, 120))
    hand.click()
    hand.press("c")
    hand.draw([(120, 120), (170, 120)])
    hand.tab.saved()
    [uid] = live_caps(project)
    kept = kept_cap(project, uid)
    assert kept is not None
    assert kept["mark"]["r"] == pytest.approx(50, abs=1)
    assert hand.done.count == on_guide("half-hidden")


def test_five_false_caps_are_swept_away(hand: Hand) -> None:
    hand.point((40, 370))
    page = hand.tab.page
    page.keyboard.down("b")
    page.mouse.move(*hand.tab.screen((200, 370)), steps=20)
    page.keyboard.up("b")
    hand.tab.saved()
    assert len(hand.tab.state("predictions")) == 8
    assert on_guide("five false ones") == 1, "a run of the pointer with a key held"


def test_ten_buds_are_ignored(hand: Hand, project: Path) -> None:
    hand.press("Shift+I")
    hand.tab.saved()
    kept = [kept_cap(project, uid) for uid in live_caps(project)]
    assert [cap["ignored"] for cap in kept if cap is not None] == [1] * 10
    assert hand.done.count == on_guide("ten buds")


def test_the_next_worst_is_shown(hand: Hand) -> None:
    hand.press("Space")
    assert len(hand.tab.state("selection")) == 1
    assert hand.done.count == on_guide("next worst")
