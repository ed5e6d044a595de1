"""One tab of a real browser, driven as a person drives it: by pointer and keys, in image coordinates."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from playwright.sync_api import Browser, Locator, Page, sync_playwright

from fairyring.app.bench.browser.chromium import FLAGS, REMEDY, find
from fairyring.model.errors import FairyringError

Point = tuple[float, float]
WAIT_MS = 30_000
ONLINE = "window.fairyring?.state.image && window.fairyring.state.connection === 'online'"
STANDS_STILL = """() => new Promise((resolve) => {
  let [place, since] = ["", performance.now()];
  const look = (now) => {
    const panel = document.querySelector("[data-dock-scroll] [role=tab]");
    const is = JSON.stringify(window.fairyring.view.toScreen(0, 0));
    if (is !== place || !panel) [place, since] = [is, now];
    if (now - since > 150) resolve();
    else requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
})"""
"""The panel comes after the photo and takes room from it, so that points of the photo move on the screen."""


@contextmanager
def chromium() -> Iterator[Browser]:
    """A headless Chromium; FairyringError where there is none."""
    path = find()
    if path is None:
        raise FairyringError(REMEDY)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=str(path), args=list(FLAGS))
        yield browser
        browser.close()


class Tab:
    """A page with the editor in it. ``errors`` collects what the page's scripts threw."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.errors: list[str] = []
        page.on("pageerror", lambda error: self.errors.append(str(error)))

    def enter(self, url: str, *, name: str) -> None:
        """Opens the page, says a name where it is asked for, and waits for the first image."""
        self.page.goto(url)
        if self.page.get_by_label("Your name").count():
            self.page.get_by_label("Your name").fill(name)
            self.page.keyboard.press("Enter")
        self.ready()

    def reload(self) -> None:
        """Loads the page again and waits until it can be worked with."""
        self.page.reload()
        self.ready()

    def ready(self) -> None:
        """Waits for the first image and for its place on the screen."""
        self.wait_for(ONLINE)
        self.page.evaluate(STANDS_STILL)

    def wait_for(self, condition: str) -> None:
        """Waits until a JavaScript expression is true."""
        self.page.wait_for_function(f"() => Boolean({condition})", timeout=WAIT_MS)

    def state(self, what: str) -> Any:
        """Part of the editor's state: shapes, predictions, selection, image, waiting, connection or tool."""
        return self.page.evaluate(f"() => JSON.parse(JSON.stringify(window.fairyring.state.{what} ?? null))")

    def screen(self, point: Point) -> Point:
        """Page coordinates of an image point."""
        at = self.page.evaluate("([x, y]) => window.fairyring.view.toScreen(x, y)", list(point))
        return at["x"], at["y"]

    def click(self, point: Point, *, count: int = 1) -> None:
        """Clicks at an image point."""
        self.page.mouse.click(*self.screen(point), click_count=count)

    def drag(self, start: Point, *way: Point) -> None:
        """Presses at an image point, moves along the way, lets go at its end."""
        self.page.mouse.move(*self.screen(start))
        self.page.mouse.down()
        for point in way:
            self.page.mouse.move(*self.screen(point), steps=6)
        self.page.mouse.up()

    def press(self, *keys: str) -> None:
        """Presses keys, one after the other."""
        for key in keys:
            self.page.keyboard.press(key)

    def accept_all(self) -> None:
        """Accepts all open predictions that are shown, whatever their score."""
        self.press("Shift+A", "Home", "Enter")

    def select(self, point: Point) -> str:
        """Clicks a cap and returns its uid."""
        self.click(point)
        self.wait_for("window.fairyring.state.selection.length === 1")
        return self.state("selection")[0]

    def open(self, file_name: str) -> None:
        """Opens an image by a click in the list."""
        self.row_of(file_name).click()
        self.wait_for(f"window.fairyring.state.image.file_name === {file_name!r}")

    def row_of(self, file_name: str) -> Locator:
        """The line of an image in the list."""
        return self.page.locator("[data-fairyring-open]").filter(has_text=file_name).first

    def saved(self) -> None:
        """Waits until every edit is acknowledged."""
        self.wait_for("window.fairyring.state.waiting === 0")

    def shape(self, uid: str) -> dict[str, Any] | None:
        """A cap as the editor has it, None where it has been deleted."""
        return next((shape for shape in self.state("shapes") if shape["uid"] == uid), None)


def centroid(part: Sequence[float]) -> Point:
    """Mean of the vertices: a point inside any roundish cap."""
    return sum(part[0::2]) / (len(part) // 2), sum(part[1::2]) / (len(part) // 2)
