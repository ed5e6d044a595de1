"""The editor's modules, loaded one by one into a page of a real browser."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

STATIC = Path(__file__).parents[3] / "static"

Call = Callable[..., Any]


class _Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_args: object) -> None:
        """Says nothing."""


@pytest.fixture(scope="session")
def static_url() -> Iterator[str]:
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(_Quiet, directory=str(STATIC)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()


@pytest.fixture(scope="module")
def tab(browser: Browser, static_url: str) -> Iterator[Page]:
    context = browser.new_context()
    opened = context.new_page()
    opened.goto(f"{static_url}/jsconfig.json")
    yield opened
    context.close()


@pytest.fixture
def page(tab: Page) -> Page:
    """A page of the editor's origin whose storage is empty."""
    tab.evaluate("localStorage.clear(); sessionStorage.clear()")
    return tab


@pytest.fixture
def call(page: Page) -> Call:
    """Calls ``body`` (JavaScript that sees the module's exports as ``m`` and the argument as ``a``)."""

    def call_(module: str, body: str, argument: object = None) -> Any:
        script = f"async ({{module, a}}) => {{ const m = await import(module); {body} }}"
        return page.evaluate(script, {"module": f"/editor/{module}.js", "a": argument})

    return call_
