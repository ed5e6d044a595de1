"""The panel: what is selected, which buttons show what is so, and that it fits small windows."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from tests.support.plain_bed import make_bed, ring

CAPS = [(150, 150), (350, 200), (500, 100)]


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_bed(tmp_path, [[ring(x, y, 40) for x, y in CAPS], []])


def top_of_tabs(page: Page) -> float:
    box = page.get_by_role("tab", name="Images").bounding_box()
    assert box is not None
    return box["y"]


def test_several_selected_are_counted_and_changed_together_and_nothing_jumps(
    server: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(server)
    card = tab.page.locator(".fr-cap")
    card.get_by_text("The image").wait_for()
    places = [top_of_tabs(tab.page)]
    tab.select(CAPS[0])
    card.get_by_text("Centre", exact=True).wait_for()
    places.append(top_of_tabs(tab.page))
    tab.page.keyboard.down("Shift")
    tab.click(CAPS[1])
    tab.page.keyboard.up("Shift")
    card.get_by_text("2 selected").wait_for()
    places.append(top_of_tabs(tab.page))
    assert len(set(places)) == 1

    card.get_by_role("button", name="Doubtful").click()
    tab.saved()
    assert sorted(shape["cap"]["doubtful"] for shape in tab.state("shapes")) == [False, True, True]
    card.get_by_text("all", exact=True).wait_for()


def test_the_status_buttons_show_the_status(server: Server, open_tab: Callable[..., Tab]) -> None:
    tab = open_tab(server)

    def pressed() -> list[str]:
        buttons = tab.page.locator(".fr-statuses button[aria-pressed=true]")
        return [text.strip() for text in buttons.all_inner_texts()]

    tab.wait_for("document.querySelector('.fr-statuses [aria-pressed=true]')")
    assert pressed() == ["To do"]
    tab.page.get_by_role("button", name="Approved").click()
    tab.wait_for("document.querySelector('[data-fairyring-command=approved][aria-pressed=true]')")
    assert pressed() == ["Approved"]
    tab.saved()
    tab.press("Control+z")
    tab.wait_for("document.querySelector('[data-fairyring-command=to_do][aria-pressed=true]')")


def test_the_tool_in_hand_is_explained_under_the_photo(server: Server, open_tab: Callable[..., Tab]) -> None:
    tab = open_tab(server)
    said = {}
    for key in "VWCRG":
        tab.press(key)
        said[key] = tab.page.locator(".fairyring-hint").inner_text()
    assert len(set(said.values())) == 5
    assert "freehand" in said["W"]


def test_every_tool_and_command_has_a_word_and_a_question_mark_means_doubtful_alone(
    server: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(server)
    buttons = tab.page.locator(".fr-tools button, .fr-commands button").all()
    assert len(buttons) > 10
    assert all(button.inner_text().strip() for button in buttons)
    assert not any("?" in button.inner_text() for button in buttons)
    tab.page.get_by_role("button", name="Keys").click()
    tab.page.get_by_role("dialog", name="Keys").wait_for()


@pytest.mark.parametrize(("width", "height"), [(1440, 860), (1366, 768), (1024, 768)])
def test_nothing_of_the_panel_is_cut(browser: Browser, server: Server, width: int, height: int) -> None:
    context = browser.new_context(viewport={"width": width, "height": height})
    tab = Tab(context.new_page())
    tab.enter(server.url, name="Ada")
    tab.select(CAPS[0])
    tab.page.locator(".fr-cap").get_by_text("Centre", exact=True).wait_for()
    tab.wait_for(f"document.querySelector('[data-dock-region=right]').offsetWidth < {width} * 0.32")
    words = ".fr-header :is(a, span), .fr-toolbar span, .fr-actions span, strong"
    too_wide = f"""() => [...document.querySelectorAll('{words}')]
        .filter((e) => e.checkVisibility() && e.scrollWidth > e.clientWidth).map((e) => e.textContent)"""
    assert tab.page.evaluate(too_wide) == []
    tab.page.keyboard.down("Shift")
    tab.click(CAPS[1])
    tab.page.keyboard.up("Shift")
    tab.page.locator(".fr-cap").get_by_text("2 selected").wait_for()
    assert tab.page.evaluate(too_wide) == []
    outside = """() => [...document.querySelectorAll('[data-dock-scroll] :is(button, input, select)')]
        .filter((e) => e.checkVisibility() && e.getBoundingClientRect().right > innerWidth).length"""
    assert tab.page.evaluate(outside) == 0
    context.close()


def test_the_developers_page_of_viser_is_out_of_sight(server: Server, open_tab: Callable[..., Tab]) -> None:
    tab = open_tab(server)
    assert tab.page.get_by_text("ws://").count() == 0
    assert not any(field.is_visible() for field in tab.page.locator("input[value^=ws]").all())
    assert not tab.page.get_by_test_id("floating-panel-handle").is_visible()


def test_a_split_is_chosen_filtered_by_and_taken_back(server: Server, open_tab: Callable[..., Tab]) -> None:
    tab = open_tab(server)
    tab.page.locator(".fr-tags select[name=split]").select_option("test")
    tab.row_of("bed_1").get_by_text("test").wait_for()
    tab.page.locator(".fairyring-notice").get_by_role("button", name="Undo").click()
    tab.row_of("bed_1").get_by_text("test").wait_for(state="detached")


def test_all_images_found_are_put_into_a_split_at_once_and_that_is_undone(
    server: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(server)
    tab.page.get_by_text("Splits").click()
    tab.page.get_by_role("button", name="Put all of them there").click()
    tab.page.get_by_text("images found: train").wait_for()
    tab.row_of("bed_1").get_by_text("train").wait_for()
    tab.page.get_by_role("button", name="Undo splits").click()
    tab.page.get_by_text("images found: none").wait_for()


def test_light_and_form_are_chosen_and_taken_back(server: Server, open_tab: Callable[..., Tab]) -> None:
    tab = open_tab(server)
    tab.page.locator(".fr-tags select[name=light]").select_option("side")
    tab.row_of("bed_1").get_by_text("side").wait_for()
    tab.page.locator(".fairyring-notice").get_by_role("button", name="Undo").click()
    tab.row_of("bed_1").get_by_text("side").wait_for(state="detached")
