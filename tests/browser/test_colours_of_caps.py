"""What caps tell of themselves by colour, by how sure their centre is, and by how much of it is drawn."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from fairyring.app.bench.browser.tab import Point, Tab
from fairyring.app.bench.serving import Server
from tests.support.plain_bed import make_bed, ring
from tests.support.screen import pixels

SURE, DOUBTFUL = (180, 200, 60), (450, 200, 60)
"""Middle and radius: said with score .95, and with .35."""
BUD = (330, 60, 9)
ORANGE, BLUE = (0x3D, 0x6A, 0xFF), (0xFF, 0xB0, 0x4F)
"""Ends of the ramp, blue, green, red."""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    caps = [ring(*SURE), ring(*DOUBTFUL, cut=440), ring(*BUD)]
    return make_bed(tmp_path, [caps], said=True, scores=[0.95, 0.35, 0.9])


@pytest.fixture
def tab(server: Server, open_tab: Callable[..., Tab]) -> Tab:
    return open_tab(server)


def seen(tab: Tab, colour: tuple[int, int, int], low: Point, high: Point) -> int:
    """How many pixels between two image points have about this colour."""
    return int((np.abs(pixels(tab, low, high).astype(int) - colour).max(axis=2) < 40).sum())


def around(cap: tuple[int, int, int], by: float = 8) -> tuple[Point, Point]:
    x, y, r = cap
    return (x - r - by, y - r - by), (x + r + by, y + r + by)


def test_a_low_score_is_orange_and_wide_a_high_one_blue_and_the_legend_says_so(tab: Tab) -> None:
    assert seen(tab, ORANGE, *around(DOUBTFUL)) == 0
    tab.page.get_by_role("tab", name="View", exact=True).click()
    tab.page.locator("[data-fairyring-look=colouring]").select_option("score")
    legend = tab.page.locator(".fairyring-legend")
    legend.wait_for()
    assert "score 1" in legend.inner_text()
    low, high = seen(tab, ORANGE, *around(DOUBTFUL)), seen(tab, BLUE, *around(SURE))
    assert min(low, high) > 40
    assert seen(tab, BLUE, *around(DOUBTFUL)) < high / 10
    assert seen(tab, ORANGE, *around(SURE)) < low / 10


def test_how_little_is_known_of_a_centre_is_drawn_by_a_layer_of_its_own(tab: Tab) -> None:
    # Of what was only imported nobody has worked that out.
    tab.accept_all()
    tab.saved()
    uncertain = (0x3D, 0x8A, 0xFF)
    middle = ((380, 130), (520, 270))
    before = seen(tab, uncertain, *middle)
    tab.press("8")
    assert seen(tab, uncertain, *middle) > before + 5
    tab.press("8")
    assert seen(tab, uncertain, *middle) == before


def test_the_cross_of_a_bud_comes_as_one_zooms_in(tab: Tab) -> None:
    def bright() -> int:
        """Pixels of the cross's colour in the middle of the bud."""
        x, y, _ = BUD
        return seen(tab, (0xFF, 0xC6, 0xD3), (x - 4, y - 4), (x + 4, y + 4))

    assert bright() == 0
    tab.page.mouse.move(*tab.screen((BUD[0], BUD[1])))
    for _ in range(12):
        tab.page.mouse.wheel(0, -100)
    tab.page.mouse.move(700, 700)
    tab.page.wait_for_timeout(300)
    assert bright() > 5
