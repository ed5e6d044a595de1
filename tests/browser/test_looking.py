"""The photo looked at in other ways; nothing of it changes a cap."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
from playwright.sync_api import Locator

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import create_project
from tests.support.screen import pixels

SIDE = 400


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A photo whose left half is a dim red and whose right half is a fine texture of little contrast."""
    photo = np.zeros((SIDE, SIDE, 3), np.uint8)
    photo[:, : SIDE // 2] = (20, 40, 120)
    photo[:, SIDE // 2 :] = 100 + 6 * (np.indices((SIDE, SIDE // 2)).sum(axis=0) // 8 % 2)[..., None]
    (tmp_path / "photos").mkdir()
    cv2.imwrite(str(tmp_path / "photos" / "bed.png"), photo)
    with create_project(tmp_path / "beds") as made:
        import_paths(made, [tmp_path / "photos"])
    return tmp_path / "beds"


@pytest.fixture
def tab(server: Server, open_tab: Callable[..., Tab]) -> Tab:
    opened = open_tab(server)
    opened.page.get_by_role("tab", name="View", exact=True).click()
    return opened


def control(tab: Tab, name: str) -> Locator:
    return tab.page.locator(f"[data-fairyring-look={name}]")


def slide(tab: Tab, name: str, value: float) -> None:
    change = "(e, v) => { e.value = v; e.dispatchEvent(new Event('input', { bubbles: true })); }"
    control(tab, name).evaluate(change, str(value))


def red_half(tab: Tab) -> list[int]:
    """Blue, green, red of the left half."""
    return pixels(tab, (60, 150), (120, 210)).reshape(-1, 3).mean(axis=0).round().astype(int).tolist()


def test_gamma_and_brightness_lighten_and_one_button_puts_them_back(tab: Tab) -> None:
    before = red_half(tab)
    slide(tab, "gamma", 2)
    expected = [round(255 * (value / 255) ** 0.5) for value in before]
    assert np.allclose(red_half(tab), expected, atol=4)
    slide(tab, "brightness", 1.5)
    assert red_half(tab)[2] > expected[2] + 40
    tab.page.get_by_role("button", name="Photo as it is").click()
    assert red_half(tab) == before
    assert control(tab, "gamma").input_value() == "1"


def test_one_channel_is_shown_as_grey_and_a_reload_keeps_it(tab: Tab) -> None:
    _, green, red = red_half(tab)
    control(tab, "channel").select_option("red")
    assert np.allclose(red_half(tab), red, atol=2)
    tab.reload()
    assert np.allclose(red_half(tab), red, atol=2)
    tab.page.get_by_role("tab", name="View", exact=True).click()
    control(tab, "channel").select_option("green")
    assert np.allclose(red_half(tab), green, atol=2)


def test_local_contrast_brings_out_a_faint_texture(tab: Tab) -> None:
    def contrast() -> float:
        return float(pixels(tab, (240, 120), (360, 280))[:, :, 1].std())

    before = contrast()
    with tab.page.expect_response(lambda answer: "contrast=local" in answer.url):
        control(tab, "local").check()
    tab.page.wait_for_timeout(500)
    assert contrast() > 1.2 * before


def test_a_loupe_follows_the_pointer(tab: Tab) -> None:
    tab.press("q")
    assert control(tab, "loupe").is_checked()
    loupe = tab.page.locator(".fairyring-loupe")
    places = []
    for point in ((100, 200), (300, 200)):
        tab.page.mouse.move(*tab.screen(point))
        loupe.wait_for()
        tab.page.wait_for_timeout(100)
        places.append(loupe.bounding_box())
    assert places[0] is not None
    assert places[1] is not None
    apart = tab.screen((300, 200))[0] - tab.screen((100, 200))[0]
    assert places[1]["x"] - places[0]["x"] == pytest.approx(apart, abs=2)
    tab.press("q")
    loupe.wait_for(state="hidden")


def test_two_fingers_move_and_zoom_the_photo(tab: Tab) -> None:
    def scale() -> float:
        return tab.page.evaluate("window.fairyring.view.scale")

    session = tab.page.context.new_cdp_session(tab.page)
    (x, y), before = tab.screen((200, 200)), scale()

    def fingers(kind: str, *places: tuple[float, float]) -> None:
        points = [{"x": at[0], "y": at[1], "id": nth} for nth, at in enumerate(places)]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    fingers("touchStart", (x - 40, y))
    fingers("touchStart", (x - 40, y), (x + 40, y))
    for wide in (50, 60, 70, 80):
        fingers("touchMove", (x - wide, y), (x + wide, y))
    tab.wait_for(f"Math.abs(window.fairyring.view.scale / {2 * before} - 1) < 0.02")
    at = tab.screen((200, 200))
    for far in (10, 20, 30):
        fingers("touchMove", (x - 80 + far, y), (x + 80 + far, y))
    tab.page.wait_for_timeout(200)
    fingers("touchEnd")
    assert tab.screen((200, 200))[0] == pytest.approx(at[0] + 30, abs=2)
    assert tab.state("selection") == []


def test_buttons_zoom(tab: Tab) -> None:
    before = tab.page.evaluate("window.fairyring.view.scale")
    tab.page.get_by_role("button", name="Zoom in").click()
    assert tab.page.evaluate("window.fairyring.view.scale") > 1.2 * before
    tab.page.get_by_role("button", name="Fit the photo").click()
    assert tab.page.evaluate("window.fairyring.view.scale") == pytest.approx(before)
