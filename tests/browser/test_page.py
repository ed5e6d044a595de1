"""The page as a browser loads it: all modules announced, nothing fetched twice, nothing refused."""

from __future__ import annotations

import re
from collections.abc import Callable
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser, BrowserContext

from fairyring.app.bench.browser.line import line_to
from fairyring.app.bench.browser.tab import STANDS_STILL, Tab
from fairyring.app.bench.serving import Server

SOCKETS = 2
NOT_IMPORTED = {"main.js", "start.js", "paint_worker.js"}
"""What starts a graph of modules: the scripts of the page, and the worker."""


def visit(context: BrowserContext, url: str) -> tuple[set[str], list[str], str]:
    """The addresses a page asked for, what the browser complained of, and the page itself."""
    page = context.new_page()
    asked: set[str] = set()
    complaints: list[str] = []
    page.on(
        "request", lambda request: asked.add(urlsplit(request.url)._replace(scheme="", netloc="").geturl())
    )
    page.on("console", lambda message: complaints.append(message.text))
    Tab(page).enter(url, name="Ada")
    page.wait_for_load_state("networkidle")
    html = page.content()
    page.close()
    return asked, complaints, html


def test_a_first_visit_fetches_each_file_once_and_later_ones_none(browser: Browser, server: Server) -> None:
    context = browser.new_context(viewport={"width": 1500, "height": 900})
    with line_to(server.port, megabits=1000, round_trip_ms=0) as line:
        context.add_cookies([{"name": "fairyring_name", "value": "Ada", "url": line.url}])
        asked, complaints, html = visit(context, line.url)
        files = {url for url in asked if url.startswith(("/static/", "/viser/", "/photos/"))}
        assert len(files) > 40
        assert line.requests == len(files) + len({"/"}) + SOCKETS
        for _ in range(3):  # what was fetched reaches the browser's cache a moment later
            line.reset()
            visit(context, line.url)
            if line.requests == len({"/"}) + SOCKETS:
                break
        assert line.requests == len({"/"}) + SOCKETS
    context.close()

    modules = {url for url in files if url.endswith(".js")}
    announced = set(re.findall(r'<link rel="modulepreload" href="([^"]*)"', html))
    assert announced <= modules
    assert {url.rsplit("/", 1)[1] for url in modules - announced} <= NOT_IMPORTED
    assert [text for text in complaints if "Security Policy" in text or "preload" in text] == []


FOLLOW_PHOTO = """
    window.places = [];
    const look = () => {
        const shown = window.fairyring?.state.image && document.querySelector("[data-fairyring-area]");
        if (shown) {
            const [a, b] = [[0, 0], [100, 100]].map(([x, y]) => window.fairyring.view.toScreen(x, y));
            window.places.push([a.x, a.y, b.x, b.y]);
        }
        requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
"""


@pytest.mark.parametrize(("window", "panel"), [(1500, 384), (1024, 308)])
def test_the_photo_stands_where_it_is_first_seen(
    browser: Browser, server: Server, window: int, panel: int
) -> None:
    context = browser.new_context(viewport={"width": window, "height": 860})
    context.add_init_script(FOLLOW_PHOTO)
    tab = Tab(context.new_page())
    tab.enter(server.url, name="Ada")
    region = tab.page.locator("[data-dock-region=right]")
    tab.page.get_by_role("tab", name="View", exact=True).click()
    tab.page.wait_for_timeout(1000)
    box = region.bounding_box()
    places = tab.page.evaluate("window.places")
    context.close()
    assert box is not None
    assert box["width"] == panel
    assert len({tuple(place) for place in places}) == 1


def test_the_panel_is_as_wide_as_somebody_draws_it(server: Server, open_tab: Callable[..., Tab]) -> None:
    tab = open_tab(server)
    tab.page.get_by_role("tab", name="View", exact=True).wait_for()
    edge = 1500 - 384
    tab.page.mouse.move(edge + 2, 400)
    tab.page.mouse.down()
    tab.page.mouse.move(edge - 98, 400, steps=8)
    tab.page.mouse.up()
    tab.page.evaluate(STANDS_STILL)
    box = tab.page.locator("#fairyring-editor").bounding_box()
    assert box is not None
    assert box["width"] == pytest.approx(edge - 100, abs=20)
