"""The page as a browser loads it: all modules announced, nothing fetched twice, nothing refused."""

from __future__ import annotations

import re
from urllib.parse import urlsplit

from playwright.sync_api import Browser, BrowserContext

from fairyring.app.bench.browser.line import line_to
from fairyring.app.bench.browser.tab import Tab
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
