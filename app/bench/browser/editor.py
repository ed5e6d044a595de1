"""How long a person waits for the editor, in headless Chromium against the real server.

Everything is measured inside the page, from the time stamp of the event to the end of what it set going.
References: a page that draws nothing, the dragged vertex itself on screen, a bare synced ``INSERT``, the
photo alone fetched and decoded.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable
from pathlib import Path

from playwright.sync_api import Browser

from fairyring.app.bench.browser import stopwatch
from fairyring.app.bench.browser.leafing import VIEWPORT, jump, leaf, measured_tab
from fairyring.app.bench.browser.tab import Point, Tab, centroid, chromium
from fairyring.app.bench.crowd import CROWD, CROWD_PHOTO, add_crowd
from fairyring.app.bench.plain import inserted_at_once, synced_inserts
from fairyring.app.bench.projects import Bed, make_project
from fairyring.app.bench.serving import served
from fairyring.app.bench.timing import Row, p95_row
from fairyring.storage.images import ImageFilter, list_images

Ids = dict[str, int]
"""Image numbers by file name."""
SIZES = {"1280 × 720": (1280, 720, 100), "4000 × 3000": (4000, 3000, 400)}
"""Width, height, and the target for a change of images in ms."""
CROWDS = {
    "100 × 60": (Bed(name="few.jpg", width=1280, height=720, caps=100, vertices=60), 20),
    "2000 × 20": (Bed(name="many.jpg", width=2000, height=1500, caps=2000, vertices=20), 35),
}
"""A bed of as many shapes × vertices, and the target from event to drawn in ms."""


def editor_rows(*, quick: bool = False) -> list[Row]:
    """Measures the editor: pointer to drawn, release to saved, move to fit, image to image."""
    moves, edits, switches = (10, 2, 1) if quick else (200, 50, 12)
    with tempfile.TemporaryDirectory(prefix="fairyring-bench-") as name, chromium() as browser:
        folder = Path(name)
        beds = [bed for bed, _ in CROWDS.values()]
        beds += [bed for size in SIZES for bed in _album(size, switches)]
        with make_project(folder, beds) as project:
            add_crowd(project, folder / "crowd")
            with project.read() as connection:
                page = list_images(connection, ImageFilter(), limit=len(beds) + 1)
        ids = {row.image.file_name: row.image.id for row in page.rows}
        blank = _blank(browser, moves)
        with served(folder / "project") as server, measured_tab(browser, server) as tab:
            rows = [row for crowd in CROWDS for row in _pointer(tab, ids, crowd, moves=moves, blank=blank)]
            rows += _editing(tab, ids, folder, count=edits)
            rows += _accepting(tab, ids, folder, times=1 if quick else 5)
            rows += _dragging_in_a_crowd(tab, moves)
            rows += [row for size in SIZES for row in _switching(tab, ids, size, count=switches)]
            return rows


def _album(size: str, switches: int) -> list[Bed]:
    """Names of the beds to leaf through, then three times as many to jump about in."""
    width, height, _ = SIZES[size]
    return [
        Bed(name=f"{width}_{seed:02}.jpg", width=width, height=height, caps=100, vertices=40, seed=seed)
        for seed in range(4 * switches + 1)
    ]


def _blank(browser: Browser, moves: int) -> list[float]:
    page = browser.new_page(viewport=VIEWPORT)
    page.set_content(stopwatch.BLANK)
    for x, y in _circle((700, 400), moves):
        page.mouse.move(x, y)
    page.wait_for_function("() => frames.length > 5")
    frames = page.evaluate("() => frames")
    page.close()
    return frames


def _circle(middle: Point, count: int, *, radius: float = 25) -> list[Point]:
    angles = [math.tau * i / 40 for i in range(count)]
    return [(middle[0] + radius * math.sin(a), middle[1] + radius * (1 - math.cos(a))) for a in angles]


def _pointer(tab: Tab, ids: Ids, crowd: str, *, moves: int, blank: list[float]) -> list[Row]:
    bed, target = CROWDS[crowd]
    jump(tab, ids[bed.name])
    gestures: dict[str, Callable[[Tab, int], None]] = {"drag": _drag, "pan": _pan, "zoom": _zoom}
    rows: list[Row] = []
    for kind, gesture in gestures.items():
        stopwatch.start(tab)
        gesture(tab, moves)
        waited, drawing = stopwatch.frames(tab, kind)
        what = f"{kind}, {crowd}"
        rows.append(p95_row(f"{what}: event to drawn (blank page)", waited, target=target, reference=blank))
        rows.append(p95_row(f"{what}: drawing alone", drawing, target=6))
        if kind == "drag":
            fit, vertex = stopwatch.laps(tab, "fit"), stopwatch.laps(tab, "vertex")
            figure = f"{what}: move to live fit on screen (to the vertex)"
            rows.append(p95_row(figure, fit, target=50, reference=vertex))
    return rows


def _vertex(tab: Tab, nth: int) -> Point:
    """Selects a cap in the middle and returns where one of its vertices is, in the page."""
    tab.press("Escape", "f")
    shapes = tab.state("shapes")
    part = shapes[(len(shapes) // 2 + nth) % len(shapes)]["cap"]["visible"][0]
    tab.select(centroid(part))
    return tab.screen((part[0], part[1]))


def _drag(tab: Tab, moves: int) -> None:
    x, y = _vertex(tab, 0)
    tab.page.mouse.move(x, y)
    tab.page.mouse.down()
    for at in _circle((x, y), moves):
        tab.page.mouse.move(*at)
    tab.page.mouse.up()
    tab.saved()


def _pan(tab: Tab, moves: int) -> None:
    tab.page.mouse.move(700, 450)
    tab.page.mouse.down(button="middle")
    for x, y in _circle((700, 450), moves, radius=200):
        tab.page.mouse.move(x, y)
    tab.page.mouse.up(button="middle")


def _zoom(tab: Tab, moves: int) -> None:
    tab.page.mouse.move(600, 400)
    for i in range(moves):
        tab.page.mouse.wheel(0, -60 if i % 40 < 20 else 60)


def _editing(tab: Tab, ids: Ids, folder: Path, *, count: int) -> list[Row]:
    bed, _ = CROWDS["100 × 60"]
    jump(tab, ids[bed.name])
    stopwatch.start(tab)
    for nth in range(count):
        x, y = _vertex(tab, nth)
        tab.page.mouse.move(x, y)
        tab.page.mouse.down()
        tab.page.mouse.move(x + 4, y + 3, steps=4)
        tab.page.mouse.up()
        tab.saved()
    reference = synced_inserts(folder / "plain.db", payload="0" * 1000)
    figure = "edit: release to on disk and acknowledged (one synced INSERT)"
    return [p95_row(figure, stopwatch.laps(tab, "saved"), target=50, reference=reference)]


def _accepting(tab: Tab, ids: Ids, folder: Path, *, times: int) -> list[Row]:
    """Accepts all predictions of a crowd, and takes that back, again and again."""
    jump(tab, ids[CROWD_PHOTO])
    caps = len(tab.state("predictions"))
    stopwatch.start(tab)
    drawn = []
    for _ in range(times):
        tab.accept_all()
        drawn.append(stopwatch.drawn_as_saved(tab))
        tab.press("Control+z")
        tab.saved()
    on_disk = stopwatch.laps(tab, "accepted")[::2]
    tab.accept_all()
    tab.saved()
    plain = inserted_at_once(folder / "plain-accepted.db", rows=caps, payload="0" * 1000)
    what = f"accept all {caps}: key to"
    return [
        p95_row(f"{what} on disk (bare INSERTs)", on_disk, target=1500, reference=[plain]),
        p95_row(f"{what} drawn as saved (to disk)", drawn, target=3000, reference=on_disk),
    ]


def _dragging_in_a_crowd(tab: Tab, moves: int) -> list[Row]:
    stopwatch.start(tab)
    _drag(tab, moves)
    fit, vertex = stopwatch.laps(tab, "fit"), stopwatch.laps(tab, "vertex")
    figure = f"drag, {CROWD} on each other: move to live fit on screen (to the vertex)"
    return [p95_row(figure, fit, target=50, reference=vertex)]


def _switching(tab: Tab, ids: Ids, size: str, *, count: int) -> list[Row]:
    *_, target = SIZES[size]
    names = [bed.name for bed in _album(size, count)]
    jump(tab, ids[names[0]])
    leafed = [leaf(tab) for _ in range(count)]
    jumped, alone = [], []
    for name in names[count + 2 :: 3]:
        jumped.append(jump(tab, ids[name]))
        alone.append(stopwatch.photo_alone(tab))
    return [
        p95_row(f"next image, {size}", leafed, target=target),
        p95_row(f"any image, {size} (its photo alone)", jumped, target=target, reference=alone),
    ]
