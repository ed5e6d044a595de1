"""A tab with a stopwatch in it, and going from image to image in it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from playwright.sync_api import Browser, ViewportSize

from fairyring.app.bench.browser import stopwatch
from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server

VIEWPORT: ViewportSize = {"width": 1500, "height": 900}
LOOK_MS = 600
"""How long somebody looks at an image before going on to the next: time to fetch that in advance."""


@contextmanager
def measured_tab(browser: Browser, server: Server) -> Iterator[Tab]:
    """A tab that has entered the server's page."""
    page = browser.new_page(viewport=VIEWPORT)
    page.add_init_script(stopwatch.SCRIPT)
    tab = Tab(page)
    try:
        tab.enter(server.url, name="Bench")
        yield tab
    finally:
        page.close()


def leaf(tab: Tab) -> float:
    """Milliseconds from the press of the key to the next image with its caps."""
    tab.page.wait_for_timeout(LOOK_MS)
    stopwatch.start(tab)
    tab.press("n")
    return stopwatch.shown(tab) - stopwatch.key_pressed(tab)


def jump(tab: Tab, image: int) -> float:
    """Milliseconds to an image that nobody could expect."""
    tab.page.wait_for_timeout(LOOK_MS)
    stopwatch.start(tab)
    asked = stopwatch.ask_for(tab, image)
    return stopwatch.shown(tab) - asked
