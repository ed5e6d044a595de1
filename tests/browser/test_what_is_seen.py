"""Only what is seen is acted on: what layers hide is left alone by every key and gesture."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from tests.support.plain_bed import make_bed, ring
from tests.support.screen import pixels

LAYERS = "23457"
"""The keys of all that is drawn of caps."""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_bed(tmp_path, [[ring(150, 150, 50), ring(350, 200, 60)]], said=True)


def test_hidden_predictions_are_neither_accepted_nor_deleted_nor_selected(
    server: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(server)
    tab.select((150, 150))
    tab.page.get_by_role("tab", name="View", exact=True).click()
    tab.page.locator("[data-fairyring-layer=prediction]").click()
    tab.wait_for("window.fairyring.state.selection.length === 0")
    tab.press("Delete", "a", "Shift+A", "d", "m", "Tab", "Escape")
    tab.click((150, 150))
    tab.page.keyboard.down("Shift")
    tab.drag((5, 5), (630, 390))
    tab.page.keyboard.up("Shift")
    tab.press("Control+a", "Delete")
    assert (tab.state("selection"), tab.state("shapes"), len(tab.state("predictions"))) == ([], [], 2)
    tab.press("7")
    tab.accept_all()
    tab.wait_for("window.fairyring.state.shapes.length === 2")


def test_hidden_caps_are_left_alone_but_ignored_ones_are_always_drawn(
    server: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(server)
    tab.accept_all()
    tab.wait_for("window.fairyring.state.shapes.length === 2")
    tab.select((350, 200))
    tab.press("i", "Escape", *LAYERS)
    tab.saved()
    tab.press("Control+a")
    assert len(tab.state("selection")) == 1, "the ignored one"
    tab.press("Escape")
    tab.click((150, 150))
    assert tab.state("selection") == []
    assert np.ptp(pixels(tab, (340, 190), (360, 210))) > 40, "hatched"
    assert np.ptp(pixels(tab, (140, 140), (160, 160))) == 0, "bare"
    tab.press("h")
    tab.page.keyboard.down("h")
    tab.press("Control+a", "Delete", "Shift+A")
    tab.page.keyboard.up("h")
    assert len(tab.state("shapes")) == 2


def test_ignoring_a_mixed_selection_ignores_all_of_it(server: Server, open_tab: Callable[..., Tab]) -> None:
    tab = open_tab(server)
    tab.accept_all()
    tab.wait_for("window.fairyring.state.shapes.length === 2")
    tab.select((350, 200))
    tab.press("i", "Control+a", "i")
    tab.saved()
    assert [shape["cap"]["ignored"] for shape in tab.state("shapes")] == [True, True]
