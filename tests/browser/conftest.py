"""A real browser, a real server, a project of generated beds."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from fairyring.app.bench.browser.tab import Tab, chromium
from fairyring.app.bench.serving import Server
from fairyring.app.demo.making import make_demo
from tests.support.forked import forked_server
from tests.support.once import made_by_the_first
from tests.support.said import RECORDING

MOST_WAIT_MS = 90_000
"""How long a test waits for what is sure to come: half a minute is too short on a busy machine."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Tries a failing test of the page once more, and says so (docs/decisions/0030)."""
    here = Path(__file__).parent
    for item in items:
        if item.path.is_relative_to(here):
            item.add_marker(pytest.mark.flaky(reruns=1))


@pytest.fixture(autouse=True)
def look_ahead(monkeypatch: pytest.MonkeyPatch) -> None:
    """Most tests point at nothing, and a network that looks at their photos takes a good part of the time."""
    monkeypatch.setenv("FAIRYRING_LOOK_AHEAD", "false")


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    # One a module: while playwright is at work its event loop runs, and asyncio.run refuses to.
    with chromium() as launched:
        yield launched


@pytest.fixture(scope="session")
def demo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made_by_the_first(tmp_path_factory, "demo", lambda folder: make_demo(folder, count=3, seed=7))


@pytest.fixture
def project(demo: Path, tmp_path: Path) -> Path:
    """Three rendered beds with what the shipped weights see in them, fresh for each test."""
    return Path(shutil.copytree(demo, tmp_path / "beds"))


@pytest.fixture
def server(project: Path) -> Iterator[Server]:
    served = forked_server(project)
    served.start()
    yield served
    if served.process and served.process.poll() is None:
        served.stop()


@pytest.fixture
def open_tab(browser: Browser) -> Iterator[Callable[..., Tab]]:
    """Opens a tab as a person with a browser of their own; a tab with page errors fails the test."""
    tabs: list[Tab] = []

    def open_(server: Server, *, name: str = "Ada") -> Tab:
        context = browser.new_context(viewport={"width": 1500, "height": 900})
        context.add_init_script(RECORDING)
        context.set_default_timeout(MOST_WAIT_MS)
        tab = Tab(context.new_page())
        tabs.append(tab)
        tab.enter(server.url, name=name)
        return tab

    yield open_
    errors = [error for tab in tabs for error in tab.errors]
    for tab in tabs:
        tab.page.context.close()
    assert errors == []
