"""Moving and zooming the photo: what is on screen is stretched meanwhile, and drawn anew in the end."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
from playwright.sync_api import FloatRect

from fairyring.app.bench.browser import stopwatch
from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import create_project
from tests.support.screen import pixels

WIDTH, HEIGHT = 600, 400
NOISE = np.random.default_rng(5).integers(40, 216, (HEIGHT, WIDTH, 3), np.uint8)
GREY = 128
LEFT, RIGHT, TOP, BOTTOM = 260, 340, 160, 240
"""A square cap."""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A photo of noise, and a grey one with a square cap on it."""
    photos = tmp_path / "photos"
    photos.mkdir()
    cv2.imwrite(str(photos / "noise.png"), NOISE)
    cv2.imwrite(str(photos / "plain.png"), np.full_like(NOISE, GREY))
    document = {
        "images": [{"id": 1, "file_name": "plain.png", "width": WIDTH, "height": HEIGHT}],
        "categories": [{"id": 1, "name": "mushroom"}],
        "annotations": [
            {
                "id": 1,
                "image_id": 1,
                "category_id": 1,
                "iscrowd": 0,
                "segmentation": [[LEFT, TOP, RIGHT, TOP, RIGHT, BOTTOM, LEFT, BOTTOM]],
            }
        ],
    }
    (tmp_path / "labels.json").write_text(json.dumps(document))
    with create_project(tmp_path / "beds") as made:
        import_paths(made, [photos])
        import_paths(made, [tmp_path / "labels.json"])
    return tmp_path / "beds"


@pytest.fixture
def tab(server: Server, open_tab: Callable[..., Tab]) -> Tab:
    return open_tab(server)


def look_at(tab: Tab, file_name: str) -> None:
    """Opens a photo and waits until it is drawn: its caps may be seen before it."""
    if tab.state("image.file_name") != file_name:
        tab.page.evaluate("() => void (fairyring.timings.length = 0)")
        tab.open(file_name)
    stopwatch.shown(tab)


def scale(tab: Tab) -> float:
    return tab.page.evaluate("window.fairyring.view.scale")


def turn_wheel(tab: Tab, steps: int) -> None:
    """Each step to a tenth more, or less where there are fewer than none."""
    tab.page.mouse.move(*tab.screen((300, 200)))
    for _ in range(abs(steps)):
        tab.page.mouse.wheel(0, -60 if steps > 0 else 60)


def pan(tab: Tab, by: tuple[float, float]) -> None:
    x, y = tab.screen((300, 200))
    tab.page.mouse.move(x, y)
    tab.page.mouse.down(button="middle")
    tab.page.mouse.move(x + by[0], y + by[1], steps=12)
    tab.page.mouse.up(button="middle")


def assert_every_pixel_is_seen(tab: Tab, low: tuple[int, int], high: tuple[int, int]) -> None:
    """In its own colour, in the middle of its square on the screen."""
    shown = pixels(tab, low, high)
    each = scale(tab)
    rows = ((np.arange(high[1] - low[1]) + 0.5) * each).astype(int)
    columns = ((np.arange(high[0] - low[0]) + 0.5) * each).astype(int)
    expected = NOISE[low[1] : high[1], low[0] : high[0]]
    assert np.abs(shown[rows][:, columns].astype(int) - expected).max() <= 2


def test_after_zooming_in_the_photo_is_sharp_and_in_its_place(tab: Tab) -> None:
    look_at(tab, "noise.png")
    turn_wheel(tab, 30)
    assert scale(tab) > 12
    assert_every_pixel_is_seen(tab, (290, 192), (312, 210))


def test_after_moving_far_the_photo_is_sharp_and_in_its_place(tab: Tab) -> None:
    look_at(tab, "noise.png")
    turn_wheel(tab, 30)
    for by in ((430, 0), (0, 260), (-90, 70)):
        pan(tab, by)
    assert_every_pixel_is_seen(tab, (280, 186), (294, 196))


def test_zooming_out_leaves_nothing_of_the_window_bare(tab: Tab) -> None:
    look_at(tab, "noise.png")
    turn_wheel(tab, 24)
    ground = tab.page.locator("#fairyring-editor").bounding_box()
    assert ground is not None
    middle = ground["y"] + ground["height"] / 2
    corner: FloatRect = {"x": ground["x"] + 2, "y": middle, "width": 40, "height": 40}
    for _ in range(10):
        turn_wheel(tab, -1)
        shot = np.frombuffer(tab.page.screenshot(clip=corner), np.uint8)
        seen = cv2.imdecode(shot, cv2.IMREAD_COLOR)
        assert seen is not None
        assert seen.mean() == pytest.approx(NOISE.mean(), abs=30)


def assert_left_edge_is_sharp(tab: Tab) -> None:
    """A blue line, a pixel and a half wide, where the cap's left edge is."""
    each = scale(tab)
    strip = pixels(tab, (LEFT - 10 / each, 200), (LEFT + 10 / each, 200 + 2 / each))[0].astype(int)
    blue = np.flatnonzero(strip[:, 0] - strip[:, 2] > 60)
    assert 8 <= blue.min() <= blue.max() <= 11
    assert len(blue) <= 3


def test_after_zooming_and_moving_outlines_are_as_thin_as_before(tab: Tab) -> None:
    look_at(tab, "plain.png")
    tab.page.mouse.move(5, 5)
    assert_left_edge_is_sharp(tab)
    for steps in (18, -18, 7):
        turn_wheel(tab, steps)
        pan(tab, (120, 40))
        tab.page.mouse.move(*tab.screen((100, 390)))
        assert_left_edge_is_sharp(tab)


def test_the_focus_is_seen_around_a_photo_that_fills_the_window(tab: Tab) -> None:
    look_at(tab, "noise.png")
    turn_wheel(tab, 12)
    tab.page.locator("#fairyring-editor").focus()
    tab.press("v")
    assert tab.page.evaluate("document.activeElement.matches('#fairyring-editor:focus-visible')")
    window = tab.page.locator("#fairyring-editor").bounding_box()
    assert window is not None
    corner = tab.page.evaluate("([x, y]) => window.fairyring.view.toImage(x, y)", [window["x"], 420])
    edge = pixels(
        tab, (corner["x"], corner["y"]), (corner["x"] + 4 / scale(tab), corner["y"] + 4 / scale(tab))
    )
    # The blue of the ring, in OpenCV's order.
    assert edge[:3, :2].reshape(-1, 3).tolist() == [[0xFF, 0xC8, 0x45]] * 6
