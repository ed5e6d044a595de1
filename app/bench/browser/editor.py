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

import numpy as np
from playwright.sync_api import Browser, Page

from fairyring.app.bench.browser import stopwatch
from fairyring.app.bench.browser.leafing import VIEWPORT, jump, leaf, measured_tab
from fairyring.app.bench.browser.tab import Point, Tab, centroid, chromium
from fairyring.app.bench.crowd import CROWD, CROWD_PHOTO, add_crowd
from fairyring.app.bench.plain import inserted_at_once, synced_inserts
from fairyring.app.bench.projects import Bed, make_project
from fairyring.app.bench.serving import served
from fairyring.app.bench.timing import Row, p95_row
from fairyring.model.json_files import read_json
from fairyring.model.scene.dataset import DOCUMENT, name_of_bed, write_beds
from fairyring.model.scene.presets import preset
from fairyring.storage.images import ImageFilter, list_ids, list_images
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import Project

LOOKS_MS = 120_000
"""So long the network may look at a photo for the first time."""
RESTS_MS = 300
"""So long the pointer rests at a place."""
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
            rendered = _add_rendered(project, folder / "rendered")
        ids = {row.image.file_name: row.image.id for row in page.rows}
        blank = _blank(browser, moves)
        with served(folder / "project") as server, measured_tab(browser, server) as tab:
            rows = [row for crowd in CROWDS for row in _pointer(tab, ids, crowd, moves=moves, blank=blank)]
            rows.append(_redrawing(tab, ids, count=edits, blank=blank["release"]))
            rows.append(_pointing(tab, rendered, count=edits))
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


def _blank(browser: Browser, moves: int) -> dict[str, list[float]]:
    """Frames of each gesture on a page that draws nothing."""
    page = browser.new_page(viewport=VIEWPORT)
    page.set_content(stopwatch.BLANK)
    gestures = {"drag": _turn_dragging, "pan": _turn_panning, "zoom": _turn_wheel, "release": _click_often}
    frames: dict[str, list[float]] = {}
    for kind, gesture in gestures.items():
        page.evaluate("() => void (frames.length = 0)")
        gesture(page, moves)
        # Events that come faster than frames share one, so there may be few.
        page.wait_for_function("() => since === null && frames.length > 0")
        frames[kind] = page.evaluate("() => frames")
    page.close()
    return frames


def _circle(middle: Point, count: int, *, radius: float = 25) -> list[Point]:
    angles = [math.tau * i / 40 for i in range(count)]
    return [(middle[0] + radius * math.sin(a), middle[1] + radius * (1 - math.cos(a))) for a in angles]


def _pointer(tab: Tab, ids: Ids, crowd: str, *, moves: int, blank: dict[str, list[float]]) -> list[Row]:
    bed, target = CROWDS[crowd]
    jump(tab, ids[bed.name])
    gestures: dict[str, Callable[[Tab, int], None]] = {"drag": _drag, "pan": _pan, "zoom": _zoom}
    rows: list[Row] = []
    for kind, gesture in gestures.items():
        stopwatch.start(tab)
        gesture(tab, moves)
        waited, drawing = stopwatch.frames(tab, kind)
        what = f"{kind}, {crowd}"
        figure = f"{what}: event to drawn (the same on a blank page)"
        rows.append(p95_row(figure, waited, target=target, reference=blank[kind]))
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
    _turn_dragging(tab.page, moves, start=_vertex(tab, 0))
    tab.saved()


def _pan(tab: Tab, moves: int) -> None:
    _turn_panning(tab.page, moves)


def _zoom(tab: Tab, moves: int) -> None:
    _turn_wheel(tab.page, moves)


def _turn_dragging(page: Page, moves: int, *, start: Point = (700, 400)) -> None:
    page.mouse.move(*start)
    page.mouse.down()
    for at in _circle(start, moves):
        page.mouse.move(*at)
    page.mouse.up()


def _turn_panning(page: Page, moves: int) -> None:
    page.mouse.move(700, 450)
    page.mouse.down(button="middle")
    for x, y in _circle((700, 450), moves, radius=200):
        page.mouse.move(x, y)
    page.mouse.up(button="middle")


def _turn_wheel(page: Page, moves: int) -> None:
    page.mouse.move(600, 400)
    for i in range(moves):
        page.mouse.wheel(0, -60 if i % 40 < 20 else 60)


def _click_often(page: Page, clicks: int) -> None:
    page.mouse.move(600, 400)
    for _ in range(clicks):
        page.mouse.down()
        page.mouse.up()


def _redrawing(tab: Tab, ids: Ids, *, count: int, blank: list[float]) -> Row:
    """Redraws a quarter of one outline after another; from letting go to the new outline drawn."""
    bed, _ = CROWDS["100 × 60"]
    jump(tab, ids[bed.name])
    tab.press("Escape", "f", "r")
    rims = [shape["cap"]["visible"][0] for shape in tab.state("shapes")]
    stopwatch.start(tab)
    for nth in range(count):
        x, y = np.reshape(rims[nth], (-1, 2)).T
        quarter = list(zip(x[: len(x) // 4].tolist(), y[: len(y) // 4].tolist(), strict=True))
        tab.drag(quarter[0], *quarter[1:])
    tab.saved()
    tab.press("v")
    drawn, _ = stopwatch.frames(tab, "release")
    return p95_row("stretch of a rim: release to redrawn (release on a blank page)", drawn, reference=blank)


def _pointing(tab: Tab, rendered: tuple[int, list[Point]], *, count: int) -> Row:
    """Rests on caps that nobody has labelled; from there to the cap drawn that the network sees."""
    image, places = rendered
    jump(tab, image)
    tab.press("e")
    tab.page.wait_for_function("() => !window.fairyring.state.asking", timeout=LOOKS_MS)
    stopwatch.start(tab)
    for place in places[:count]:
        tab.page.mouse.move(*tab.screen(place))
        tab.page.wait_for_timeout(RESTS_MS)
    tab.press("v")
    figure = "pointing: pointer at rest to the network's cap drawn"
    return p95_row(figure, stopwatch.laps(tab, "preview"), target=60)


def _add_rendered(project: Project, folder: Path) -> tuple[int, list[Point]]:
    """A rendered bed without labels: its number, and places on its caps."""
    write_beds(folder, preset("paper"), count=1, seed=3005)
    import_paths(project, [folder / "images"], link=True)
    with project.read() as connection:
        (image,) = list_ids(connection, ImageFilter(search=name_of_bed(0)))
    caps = read_json(folder / DOCUMENT)["annotations"]
    return image, [centroid(max(cap["segmentation"], key=len)) for cap in caps]


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
