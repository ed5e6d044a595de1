"""Caps are marked again on a mirrored piece of the photo, without their first mark."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import expect

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.model.geometry.shapes import Circle
from fairyring.storage.contents import load_annotation
from fairyring.storage.project import open_project
from fairyring.storage.records import Repeat, Rules
from fairyring.storage.repeats import all_repeats, due_repeat
from fairyring.storage.rules import rules_of, set_rules
from tests.support.annotated_beds import RADIUS, make_annotated_beds
from tests.support.tab import until

OpenTab = Callable[..., Tab]
OFF = 3.0
"""How far off to the right, pixels, Ada puts the centre when she marks a cap again."""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    path = make_annotated_beds(tmp_path, count=2)
    with open_project(path) as opened:
        opened.write(lambda connection: set_rules(connection, Rules(repeat_share=1.0)))
    return path


def rules(project: Path) -> Rules:
    with open_project(project) as opened, opened.read() as connection:
        return rules_of(connection)


def kept(project: Path) -> list[Repeat]:
    with open_project(project) as opened, opened.read() as connection:
        return [each for each, _, _ in all_repeats(connection)]


def due(project: Path, *, besides: int) -> tuple[str, Circle]:
    """The cap that is asked for next, and how it was marked."""
    with open_project(project) as opened, opened.read() as connection:
        found = due_repeat(connection, user="Ada", besides=besides)
        assert found is not None
        assert found.mirrored
        cap = load_annotation(connection, found.annotation)
    assert cap is not None
    assert isinstance(cap.cap.mark, Circle)
    return cap.uid, cap.cap.mark


def drag_circle(tab: Tab, mark: Circle, box: list[float]) -> None:
    """Drags a circle out on the mirrored piece, ``OFF`` to the right of the mark as it lies on the photo."""
    canvas = tab.page.get_by_role("dialog", name="Mark this cap").locator("canvas").bounding_box()
    assert canvas is not None
    scale = canvas["width"] / (box[2] - box[0])
    x = canvas["x"] + canvas["width"] - (mark.cx + OFF - box[0]) * scale
    y = canvas["y"] + (mark.cy - box[1]) * scale
    tab.page.mouse.move(x, y)
    tab.page.mouse.down()
    tab.page.mouse.move(x + RADIUS * scale, y, steps=4)
    tab.page.mouse.up()


def test_caps_are_marked_again_mirrored_and_what_comes_of_it_is_no_label(
    project: Path, server: Server, open_tab: OpenTab
) -> None:
    tab = open_tab(server, name="Ada")
    tab.page.evaluate(WATCH)
    uid, first = due(project, besides=1)
    tab.press("Shift+O")
    dialog = tab.page.get_by_role("dialog", name="Mark this cap")
    dialog.get_by_role("button", name="Take it").wait_for()
    asked = tab.page.evaluate("window.asked")
    assert (asked["annotation"], asked["mirrored"], asked["mark"], asked["left"]) == (uid, True, "circle", 5)
    left, top, right, bottom = asked["box"]
    assert left < first.cx - RADIUS < first.cx + RADIUS < right
    assert top < first.cy - RADIUS < first.cy + RADIUS < bottom
    assert math.hypot(asked["at"][0] - first.cx, asked["at"][1] - first.cy) < RADIUS + 1
    drag_circle(tab, first, asked["box"])
    tab.press("Enter")
    tab.wait_for("window.asked.left === 4")
    dialog.locator("button:disabled").wait_for()  # the next one has no mark yet
    (repeat,) = kept(project)
    assert (repeat.annotation, repeat.user, repeat.first) == (uid, "Ada", first)
    assert isinstance(repeat.second, Circle)
    assert repeat.second.cx - first.cx == pytest.approx(OFF, abs=0.5)
    assert repeat.second.cy == pytest.approx(first.cy, abs=0.5)
    assert repeat.second.r == pytest.approx(RADIUS, abs=1)
    tab.press("Escape")
    dialog.wait_for(state="detached")
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_label("Marked again").get_by_role("row", name="Ada").wait_for()
    assert tab.state("image.id") == 1
    assert tab.state("waiting") == 0
    with open_project(project) as opened, opened.read() as connection:
        cap = load_annotation(connection, uid)
    assert cap is not None
    assert (cap.cap.mark, cap.revision) == (first, 1)


def test_whoever_finishes_an_image_is_asked_for_one_cap_of_another(
    project: Path, server: Server, open_tab: OpenTab
) -> None:
    tab = open_tab(server, name="Ada")
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_text("Rules of this project").click()
    expect(tab.page.get_by_label("Mark again %")).to_have_value("100", timeout=30_000)
    tab.page.get_by_label("Seed of these").fill("7")
    tab.press("Tab")
    tab.page.evaluate("document.activeElement.blur()")
    assert tab.state("image.id") == 1
    tab.press("Control+Enter")
    tab.page.get_by_role("alertdialog").wait_for()
    tab.press("Tab", "Enter")
    tab.page.get_by_role("dialog", name="Mark this cap").wait_for()
    assert tab.state("image.id") == 2
    tab.press("Escape")
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_text("No cap was marked again yet").wait_for()
    assert rules(project).repeat_seed == 7
    tab.page.get_by_label("Mark again %").fill("50")
    tab.press("Tab")
    until(lambda: rules(project).repeat_share == 0.5, "the share")


WATCH = """() => {
  const heard = Object.getOwnPropertyDescriptor(MessageEvent.prototype, "data").get;
  Object.defineProperty(MessageEvent.prototype, "data", { get() {
    const data = heard.call(this);
    if (typeof data === "string" && data.includes('"mark_again"')) window.asked = JSON.parse(data);
    return data;
  } });
}"""
