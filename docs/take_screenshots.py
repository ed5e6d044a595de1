"""Takes the pictures of the README and the guide from a fresh demo project: ``make pictures``."""

from __future__ import annotations

import json
import math
import re
import tempfile
from pathlib import Path

from playwright.sync_api import ViewportSize

from fairyring.app.bench.browser.tab import Tab, centroid, chromium
from fairyring.app.bench.serving import Server
from fairyring.app.demo.making import make_demo
from fairyring.storage.choices import ImportAs
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import open_project

PICTURES = Path(__file__).parent / "pictures"
WINDOW: ViewportSize = {"width": 1440, "height": 860}
SHOWN = (490.0, 225.0)
"""A cap of the first bed with others on every side."""


def main() -> None:
    """Serves a demo project of four beds and walks through it."""
    PICTURES.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, chromium() as browser:
        make_demo(Path(folder) / "demo", count=4, seed=1)
        server = Server(Path(folder) / "demo")
        server.start()
        try:
            tab = Tab(browser.new_page(viewport=WINDOW))
            tab.enter(server.url, name="Ada")
            _walk(tab)
            _two_annotators(tab, Path(folder))
        finally:
            server.stop()


def _walk(tab: Tab) -> None:
    _take(tab, "image")
    tab.accept_all()
    tab.saved()
    caps = [cap for cap in tab.state("shapes") if len(cap["cap"]["visible"]) == 1]
    caps.sort(key=lambda cap: -len(cap["cap"]["visible"][0]))
    middle = min(caps, key=lambda cap: math.dist(centroid(cap["cap"]["visible"][0]), SHOWN))
    place = centroid(middle["cap"]["visible"][0])
    tab.select(place)
    tab.press("z")
    # What the server has to say of it: in the panel, and in the line at the bottom.
    tab.page.get_by_text(re.compile("^Cap [0-9a-f]{8}")).wait_for()
    tab.page.locator(".fairyring-caption").wait_for()
    tab.page.wait_for_function("() => !window.fairyring.state.asking", timeout=120_000)
    _take(tab, "selected")
    _drag_a_vertex(tab, middle["cap"]["visible"][0])
    _circle_loosely(tab, middle)
    _mark_some(tab, caps[:12])
    tab.press("Escape", "v", "f")
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_text("mean CDR").wait_for()
    tab.page.locator(".fr-badge", has_text="out of date").first.wait_for(state="hidden")
    _take(tab, "review")
    tab.page.locator(".u-over").first.scroll_into_view_if_needed()
    _take(tab, "plots")
    _mark_again(tab)
    tab.press("?")
    _take(tab, "keys")


def _two_annotators(tab: Tab, folder: Path) -> None:
    """What Ben labelled of the same photo beside Ada's, at one of the caps that he left out."""
    tab.press("Escape", "Escape")
    image, shapes = tab.state("image"), tab.state("shapes")
    bens = folder / "ben.json"
    bens.write_text(json.dumps(_labels_of_ben(image, [each for each in shapes if not each["deleted"]])))
    with open_project(folder / "demo") as project:
        import_paths(project, [bens], as_=ImportAs.second)
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_text("Two annotators", exact=True).click()
    tab.page.get_by_role("combobox", name="Second annotator", exact=True).click()
    tab.page.get_by_role("option", name=bens.name, exact=True).filter(visible=True).click()
    tab.page.get_by_role("button", name="Compare all images with this version").click()
    images = tab.page.get_by_role("table", name="Images of two annotators")
    images.wait_for()
    tab.press(".", "z")
    images.scroll_into_view_if_needed()
    _take(tab, "annotators")


def _labels_of_ben(image: dict, caps: list[dict]) -> dict:
    """The same caps a little aside, but for every eighth, and the marks of those that Ada marked."""
    labels = []
    for number, cap in enumerate(caps):
        dx, dy, whole = 1.5 * (number % 5 - 2), 1.5 * (number % 3 - 1), cap["whole"]
        visible = cap["cap"]["visible"]
        rings = [[value + (dx, dy)[nth % 2] for nth, value in enumerate(ring)] for ring in visible]
        label = {"id": number + 1, "image_id": 1, "category_id": 1, "segmentation": rings}
        if cap["cap"]["mark"]:
            label["circle"] = [whole["cx"] + dx, whole["cy"] + dy, whole.get("r") or whole["a"]]
        if number % 8:
            labels.append(label)
    size = {"width": image["width"], "height": image["height"]}
    images = [{"id": 1, "file_name": image["file_name"], **size}]
    return {"images": images, "annotations": labels, "categories": [{"id": 1, "name": "mushroom"}]}


def _mark_again(tab: Tab) -> None:
    """The dialog in which a cap of another photo is marked again, half done."""
    tab.page.get_by_text("Rules of this project").click()
    tab.page.get_by_label("Mark again %").fill("100")
    tab.press("Tab")
    tab.page.evaluate("document.activeElement.blur()")
    tab.press("n")
    tab.page.wait_for_function("() => window.fairyring.state.image.id === 2")
    tab.press("Shift+O")
    canvas = tab.page.get_by_role("dialog", name="Mark this cap").locator("canvas")
    canvas.wait_for()
    box = canvas.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    tab.page.mouse.move(x, y)
    tab.page.mouse.down()
    tab.page.mouse.move(x + box["width"] / 4.4, y, steps=4)
    tab.page.mouse.up()
    _take(tab, "again")
    tab.press("Escape")
    canvas.wait_for(state="hidden")
    tab.press("p")
    tab.page.wait_for_function("() => window.fairyring.state.image.id === 1")


def _drag_a_vertex(tab: Tab, part: list[float]) -> None:
    x, y = tab.screen((part[0], part[1]))
    tab.page.mouse.move(x, y)
    tab.page.mouse.down()
    tab.page.mouse.move(x + 26, y - 18, steps=6)
    _take(tab, "dragging")
    tab.page.mouse.up()
    tab.saved()
    tab.press("Control+z")


def _circle_loosely(tab: Tab, cap: dict) -> None:
    """Draws a cap anew, by a loose circle; the rim near it is offered."""
    x, y, radius = cap["whole"]["cx"], cap["whole"]["cy"], (cap["whole"]["a"] + cap["whole"]["b"]) / 2
    # Away from its vertices, of which Delete would take one.
    tab.page.mouse.move(*tab.screen((x, y)))
    tab.press("Delete", "c")
    tab.drag((x + 3, y - 3), (x + 3 + 1.1 * radius, y - 3))
    tab.wait_for("window.fairyring.state.suggestion")
    # What was taken back before is said for a while.
    tab.page.locator(".fairyring-notice").first.wait_for(state="detached")
    _take(tab, "rim")
    tab.press("Escape", "v", "Control+z", "Control+z")
    tab.saved()


def _mark_some(tab: Tab, caps: list[dict]) -> None:
    """Places circle marks a little off the centres that were found, as a hand would."""
    tab.press("Escape", "f")
    for number, cap in enumerate(caps):
        whole = cap["whole"]
        x, y = whole["cx"] + 0.6 * (number % 3 - 1), whole["cy"] + 0.5 * (number % 2)
        radius = whole.get("r") or (whole["a"] + whole["b"]) / 2
        if radius < x < 1280 - radius and radius < y < 720 - radius:
            tab.press("v")
            tab.select((x, y))
            tab.press("c")
            tab.drag((x, y), (x + radius, y))
            tab.press("Escape", "Escape")
            tab.saved()


PHOTO_IS_THERE = """performance.getEntriesByType("resource").some(
    ({ name, responseEnd }) => /\\/photos\\/.*w=2000/.test(name) && responseEnd > 0)"""


def _take(tab: Tab, name: str) -> None:
    tab.wait_for(PHOTO_IS_THERE)
    tab.page.wait_for_timeout(1500)
    tab.page.screenshot(path=PICTURES / f"{name}.jpg", type="jpeg", quality=82)


if __name__ == "__main__":
    main()
