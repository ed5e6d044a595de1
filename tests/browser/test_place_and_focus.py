"""Where one is, and who hears keys."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Locator

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from tests.support.plain_bed import make_bed, ring
from tests.support.said import said

SMALL = ring(560, 350, 4, count=8)

MOST_BUTTONS = 8
"""How many buttons there are at most beside the photo, after its caps."""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    bed = [ring(150, 150, 50), ring(350, 200, 60)]
    return make_bed(tmp_path, [[*bed, SMALL], bed, bed])


@pytest.fixture
def tab(server: Server, open_tab: Callable[..., Tab]) -> Tab:
    return open_tab(server)


def scale(tab: Tab) -> float:
    return tab.page.evaluate("window.fairyring.view.scale")


def middle(tab: Tab) -> tuple[float, float]:
    """What is looked at: the point of the photo in the middle of the editor, in pixels."""
    box = tab.page.locator("#fairyring-editor").bounding_box()
    assert box is not None
    (x, y), zoom = tab.screen((0, 0)), scale(tab)
    return (box["x"] + box["width"] / 2 - x) / zoom, (box["y"] + box["height"] / 2 - y) / zoom


def margins(tab: Tab) -> list[int]:
    """Between the photo and the edges of the editor: left, top, right, bottom; CSS pixels."""
    box = tab.page.locator("#fairyring-editor").bounding_box()
    assert box is not None
    (left, top), (right, bottom) = tab.screen((0, 0)), tab.screen((640, 400))
    edges = (left - box["x"], top - box["y"])
    return [
        round(edge) for edge in (*edges, box["x"] + box["width"] - right, box["y"] + box["height"] - bottom)
    ]


def test_a_reload_and_the_history_lead_to_the_image_and_the_view_that_were_left(tab: Tab) -> None:
    tab.open("bed_2.png")
    tab.select((150, 150))
    tab.press("z")
    before = scale(tab), middle(tab)
    tab.reload()
    assert tab.state("image.file_name") == "bed_2.png"
    assert scale(tab) == before[0]
    assert middle(tab) == pytest.approx(before[1], abs=1)
    tab.page.go_back()
    tab.wait_for("window.fairyring.state.image.file_name === 'bed_1.png'")
    tab.page.go_forward()
    tab.wait_for("window.fairyring.state.image.file_name === 'bed_2.png'")


def test_a_link_leads_to_its_image(tab: Tab) -> None:
    tab.open("bed_3.png")
    link = tab.page.url
    page = tab.page.context.new_page()
    page.goto(link)
    other = Tab(page)
    other.ready()
    assert other.state("image.file_name") == "bed_3.png"
    assert other.errors == []


def test_a_link_leads_to_its_cap_and_so_does_a_reload(tab: Tab) -> None:
    tab.open("bed_2.png")
    uid = tab.select((150, 150))
    link = tab.page.url
    assert link.endswith(f"#/image/2/cap/{uid}")
    page = tab.page.context.new_page()
    page.goto(link)
    other = Tab(page)
    other.ready()
    other.wait_for("window.fairyring.state.selection.length === 1")
    assert (other.state("image.file_name"), other.state("selection")) == ("bed_2.png", [uid])
    other.press("Escape")
    assert page.url.endswith("#/image/2")
    assert other.errors == []
    page.close()
    tab.page.bring_to_front()
    tab.reload()
    tab.wait_for(f"window.fairyring.state.selection[0] === {uid!r}")


def test_a_whole_photo_stays_whole_in_another_window(tab: Tab) -> None:
    for size in ((1000, 600), (1600, 1000), (1100, 1000)):
        tab.page.set_viewport_size({"width": size[0], "height": size[1]})
        tab.page.wait_for_timeout(300)
        assert min(margins(tab)) == 12


def test_no_step_towards_a_small_cap_zooms_in_ten_times(tab: Tab) -> None:
    for step in ("z", "z", "Tab", "double"):
        tab.press("f", "Escape")
        if step != "Tab":
            tab.select((560, 350))
        before = scale(tab)
        if step == "double":
            tab.click((560, 350), count=2)
        else:
            tab.press(*[step] * (3 if step == "Tab" else 1))
        assert len(tab.state("selection")) == 1
        assert 1 < scale(tab) / before < 10


def test_undo_leaves_the_view_where_it_is(tab: Tab) -> None:
    tab.select((350, 200))
    tab.press("d")
    tab.saved()
    tab.select((560, 350))
    tab.press("z", "z")
    before = scale(tab), middle(tab)
    tab.press("Control+z")
    said(tab, "out of sight")
    assert (scale(tab), middle(tab)) == before


def test_keys_work_after_every_kind_of_control_and_only_text_takes_letters(tab: Tab) -> None:
    page = tab.page
    uid = tab.select((150, 150))

    def doubtful() -> bool:
        shape = tab.shape(uid)
        assert shape is not None
        return shape["cap"]["doubtful"]

    def works(after: str) -> None:
        before = doubtful()
        page.wait_for_timeout(100)
        tab.press("d")
        assert doubtful() != before, after

    def visible(selector: str) -> Locator:
        return page.locator(selector).locator("visible=true")

    page.get_by_role("tab", name="View", exact=True).click()
    visible("input[type=checkbox]").first.wait_for()
    works("a tab")
    visible("input[type=checkbox]").nth(5).click()
    works("a check box")
    slider = visible("input[type=range]").first.bounding_box()
    assert slider is not None
    page.mouse.move(slider["x"] + 5, slider["y"] + 5)
    page.mouse.down()
    page.mouse.move(slider["x"] + 40, slider["y"] + 5, steps=4)
    page.mouse.up()
    works("a slider")
    visible("[data-fairyring-command=plain_photo]").first.click()
    works("a button")
    visible("select").first.select_option(index=1)
    works("a list of the editor's own")
    page.get_by_role("tab", name="Jobs", exact=True).click()
    number = visible("input[inputmode=decimal]").first
    number.click()
    before = doubtful()
    tab.press("d")
    assert doubtful() == before, "a field for numbers keeps what is typed"
    tab.press("Enter")
    works("a number and Enter")

    page.get_by_role("tab", name="Images", exact=True).click()
    search = visible("input[type=text], input:not([type])").first
    search.click()
    before = doubtful()
    page.keyboard.type("dn")
    assert (search.input_value(), doubtful(), tab.state("image.id")) == ("dn", before, 1)
    page.keyboard.press("Control+a")
    tab.press("Delete", "Escape")
    works("a search and Escape")
    page.get_by_text("Filter and order").click()
    lists = visible("input[aria-haspopup=listbox]")
    lists.first.wait_for()
    works("a folder")
    lists.first.click()
    visible("[role=option]").first.click()
    works("a choice in a list by pointer")
    lists.nth(1).click()
    tab.press("ArrowDown", "Enter")
    works("a choice in a list by keys")
    page.locator(".fairyring-zoom").get_by_role("button", name="Fit the photo").click()
    works("a button of the editor's")
    assert len(tab.state("selection")) == 1


def test_tab_goes_from_cap_to_cap_and_on_into_the_panel_and_f6_leads_there_and_back(tab: Tab) -> None:
    inside = "Boolean(document.activeElement.closest('#fairyring-editor'))"
    tab.click((600, 20))
    caps = []
    for _ in range(3):
        tab.press("Tab")
        caps += tab.state("selection")
    assert len(set(caps)) == 3
    assert tab.page.evaluate(inside)
    for _ in range(MOST_BUTTONS):
        tab.press("Tab")
        if not tab.page.evaluate(inside):
            break
    assert not tab.page.evaluate(inside)
    tab.press("F6")
    assert tab.page.evaluate(inside)
    tab.press("F6")
    assert not tab.page.evaluate(inside)
    tab.press("Delete")
    tab.wait_for("window.fairyring.state.shapes.length === 2")
