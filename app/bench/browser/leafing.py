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
"""How long somebody looks at an image before the next; meanwhile that is fetched in advance."""


@contextmanager
def measured_tab(browser: Browser, server: Server) -> Iterator[Tab]:
    """Opens the server's page in a tab."""
    page = browser.new_page(viewport=VIEWPORT)
    page.add_init_script(stopwatch.SCRIPT)
    tab = Tab(page)
    try:
        tab.enter(server.url, name="Bench")
        yield tab
    finally:
        page.close()


def leaf(tab: Tab) -> float:
    """Presses the key for the next image; milliseconds until that stands there with its caps."""
    tab.page.wait_for_timeout(LOOK_MS)
    stopwatch.start(tab)
    tab.press("n")
    return stopwatch.shown(tab) - stopwatch.key_pressed(tab)


def jump(tab: Tab, image: int) -> float:
    """Opens an image that was not fetched in advance; milliseconds until it stands there."""
    tab.page.wait_for_timeout(LOOK_MS)
    stopwatch.start(tab)
    asked = stopwatch.ask_for(tab, image)
    return stopwatch.shown(tab) - asked
