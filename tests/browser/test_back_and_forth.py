"""What is in hand after an undo and a redo."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from fairyring.app.bench.browser.tab import Point, Tab
from fairyring.app.bench.serving import Server
from tests.support.plain_bed import make_bed, ring
from tests.support.said import said

MIDDLE, BESIDE = (350, 200), (475, 200)


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_bed(tmp_path, [[ring(*MIDDLE, 60), ring(*BESIDE, 60)]], said=True)


@pytest.fixture
def tab(server: Server, open_tab: Callable[..., Tab]) -> Tab:
    return open_tab(server)


def bow(radius: float) -> list[Point]:
    """From the rim of the cap in the middle over to the one beside it, and back."""
    turns = [math.radians(degrees) for degrees in range(-40, 41, 5)]
    x, y = MIDDLE
    ends = [(x + 60 * math.cos(turn), y + 60 * math.sin(turn)) for turn in (turns[0], turns[-1])]
    return [ends[0], *((x + radius * math.cos(turn), y + radius * math.sin(turn)) for turn in turns), ends[1]]


def test_a_cap_that_took_from_its_neighbour_is_alone_in_hand_after_undo_and_redo(tab: Tab) -> None:
    uid = tab.select(MIDDLE)
    tab.press("r")
    tab.drag(*bow(80))
    tab.wait_for("window.fairyring.state.shapes.length === 2")
    changed = tab.state("selection")
    assert len(changed) == 1
    tab.press("Control+z")
    tab.wait_for("window.fairyring.state.shapes.length === 0")
    assert tab.state("selection") == [uid]
    said(tab, "Taken back: accepted 2 predictions.")
    tab.press("Control+y")
    tab.wait_for("window.fairyring.state.shapes.length === 2")
    said(tab, "Done again: accepted 2 predictions.")
    [again] = tab.state("selection")
    kept = tab.shape(again)
    assert kept is not None
    assert kept["cap"]["prediction"] == int(uid.removeprefix("prediction:"))


def test_caps_changed_together_are_selected_together_after_an_undo(tab: Tab) -> None:
    tab.select(MIDDLE)
    tab.page.keyboard.down("Shift")
    tab.click(BESIDE)
    tab.page.keyboard.up("Shift")
    tab.press("Delete")
    tab.wait_for("window.fairyring.state.predictions.length === 0")
    tab.press("Control+z")
    tab.wait_for("window.fairyring.state.predictions.length === 2")
    assert len(tab.state("selection")) == 2
