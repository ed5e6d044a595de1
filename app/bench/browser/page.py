"""How soon the page is there after the command is typed, and what it costs on a slow line, visit by visit.

Bytes and requests are counted on the line itself, headers and WebSockets included. Reference for the start:
the same command asked for its version alone, which is Python and the command line.
"""

from __future__ import annotations

import subprocess
import tempfile
import time
from pathlib import Path

from playwright.sync_api import Browser

from fairyring.app.bench.browser import stopwatch
from fairyring.app.bench.browser.leafing import VIEWPORT
from fairyring.app.bench.browser.line import Line, line_to
from fairyring.app.bench.browser.tab import ONLINE, Tab, chromium
from fairyring.app.bench.projects import Bed, make_project
from fairyring.app.bench.serving import FAIRYRING, Server
from fairyring.app.bench.timing import Row, milliseconds, row

MEGABITS, ROUND_TRIP_MS = 8, 40
"""A second, and there and back: a line of many homes."""
BED = Bed(name="bed.jpg", width=320, height=240, caps=50, vertices=20)
"""Small, for it is the page that is measured."""


def page_rows(*, quick: bool = False) -> list[Row]:
    """The table: start, first visit, second visit."""
    starts = 1 if quick else 5
    with tempfile.TemporaryDirectory(prefix="fairyring-bench-") as name, chromium() as browser:
        make_project(Path(name), [BED]).close()
        server = Server(Path(name) / "project")
        return [_start(server, count=starts), *_visits(server, browser)]


def _start(server: Server, *, count: int) -> Row:
    """The last start is left running."""
    taken = []
    for nth in range(count):
        if nth:
            server.stop()
        began = time.perf_counter()
        server.start()
        taken.append(time.perf_counter() - began)
    command = [*FAIRYRING, "--version"]
    plain = milliseconds(lambda _: subprocess.run(command, check=True, capture_output=True), range(count))
    return row(
        "fairyring serve: typed to answering, median (fairyring --version)",
        sorted(taken)[count // 2],
        unit="s",
        target=4,
        reference=sorted(plain)[count // 2] / 1e3,
    )


def _visits(server: Server, browser: Browser) -> list[Row]:
    context = browser.new_context(viewport=VIEWPORT)
    context.add_init_script(stopwatch.SCRIPT)
    rows: list[Row] = []
    with line_to(server.port, megabits=MEGABITS, round_trip_ms=ROUND_TRIP_MS) as line:
        # The name is asked for on a page of its own, which is not what is measured.
        context.add_cookies([{"name": "fairyring_name", "value": "Bench", "url": line.url}])
        for visit in ("first visit", "second visit"):
            rows += _visit(visit, Tab(context.new_page()), line)
    context.close()
    server.stop()
    return rows


def _visit(name: str, tab: Tab, line: Line) -> list[Row]:
    line.reset()
    began = time.perf_counter()
    tab.page.goto(line.url)
    tab.wait_for(ONLINE)
    stopwatch.shown(tab)
    taken = time.perf_counter() - began
    tab.page.wait_for_load_state("networkidle")
    tab.page.close()
    return [
        row(f"{name}: requests", line.requests, unit=""),
        row(f"{name}: to the browser", line.down / 1e3, unit="kB"),
        row(f"{name}: image on screen, {MEGABITS} Mbit/s and {ROUND_TRIP_MS} ms", taken, unit="s"),
    ]
