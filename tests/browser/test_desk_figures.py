"""Figures of all images, which lead to the caps that they count."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Error as NotThere
from playwright.sync_api import Locator, expect

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.storage.images import set_light_and_form
from fairyring.storage.project import open_project
from tests.support.annotated_beds import make_annotated_beds, uid_of
from tests.support.desk import choose, on_image, selected, status_of

OpenTab = Callable[..., Tab]


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_annotated_beds(tmp_path, count=3)


def drag(tab: Tab, start: tuple[float, float], end: tuple[float, float]) -> None:
    """From one point of the image to another."""
    tab.page.mouse.move(*tab.screen(start))
    tab.page.mouse.down()
    tab.page.mouse.move(*tab.screen(end), steps=4)
    tab.page.mouse.up()


def hover_until_named(tab: Tab, words: Locator, *, across: float) -> None:
    """Moves over the first plot until it names a point: one that is drawn anew has forgotten the pointer."""
    drawn = tab.page.locator(".u-over").first
    for _ in range(20):
        try:
            box = drawn.bounding_box(timeout=3000) or {"width": 0.0}
            drawn.hover(position={"x": across * box["width"], "y": 20}, timeout=3000)
            words.wait_for(timeout=1500)
        except NotThere:
            continue
        return
    raise AssertionError(f"The plot names no point {across:.0%} across")


def test_the_worst_caps_of_all_images_and_what_is_counted_lead_to_the_caps(
    project: Path, server: Server, open_tab: OpenTab
) -> None:
    tab = open_tab(server, name="Rev")
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_role("button", name="Bring up to date").click()
    caps = tab.page.get_by_role("group", name="Caps of all images")
    caps.get_by_role("button", name="12 measured").wait_for()
    worst = caps.locator(".fr-gallery button")
    # Ada's second cap of each of the three images is the worst of its image.
    assert [worst.nth(n).get_attribute("data-fairyring-select") for n in range(3)] == [
        uid_of(image, 1) for image in (1, 2, 3)
    ]
    assert worst.first.locator("polygon").count() == 2
    assert worst.first.locator("line").count() == 1
    worst.nth(2).click()
    on_image(tab, 3)
    selected(tab, uid_of(3, 1))
    assert tab.state("review.on") is True
    tab.page.get_by_text("3 of 3 differences").wait_for()
    caps.get_by_role("button", name="3 missed").click()
    caps.get_by_text("1–3 of 3. Annotated, and not predicted.").wait_for()
    worst.first.click()
    selected(tab, uid_of(1, 4))
    caps.get_by_role("button", name="3 extra").click()
    caps.get_by_text("1–3 of 3. Predicted, and not annotated.").wait_for()
    worst.nth(1).click()
    on_image(tab, 2)
    tab.wait_for("window.fairyring.state.selection[0]?.startsWith('prediction:')")
    (turned_down,) = tab.state("selection")
    tab.press("Delete")
    tab.saved()
    # A page that is loaded anew knows of it, too.
    tab.page.reload()
    tab.wait_for("window.fairyring?.state.connection === 'online'")
    tab.page.get_by_role("tab", name="Review").click()
    caps.get_by_role("button", name="3 extra").click()
    caps.get_by_text("Predicted, and not annotated.").wait_for()
    worst.nth(1).click()
    selected(tab, turned_down)
    tab.page.get_by_text("extra: turned down").wait_for()
    card = tab.page.get_by_label("Selected cap")
    card.get_by_text(f"Prediction {turned_down.removeprefix('prediction:')}").wait_for()
    tab.press("s")
    tab.saved()
    assert len(tab.state("shapes")) == 6
    assert tab.page.get_by_role("button", name="Keep mine").count() == 0
    tab.press("Escape", "f", "c")
    # A circle around the cap that Ada drew, which is not selected, is a mark of that cap.
    drag(tab, (400.0, 300.0), (444.0, 300.0))
    selected(tab, uid_of(2, 4))
    tab.saved()
    assert len(tab.state("shapes")) == 6
    tab.press("Shift+Enter")
    tab.page.get_by_text("You have changed caps of bed_2.png").wait_for()
    other = open_tab(server, name="Zoe")
    other.open("bed_2.png")
    other.press("Shift+Enter")
    other.page.get_by_text("Approved bed_2.png.").wait_for()
    assert status_of(project, 2) == "approved"


def test_figures_can_be_grouped_kept_and_plotted_and_a_click_on_a_plot_opens_the_cap(
    project: Path, server: Server, open_tab: OpenTab
) -> None:
    with open_project(project) as opened:
        opened.write(lambda connection: set_light_and_form(connection, 2, light=None, form="b"))
    tab = open_tab(server, name="Rev")
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_role("button", name="Bring up to date").click()
    plot = tab.page.get_by_role("group", name="CDR of each image, %")
    plot.wait_for()
    hover_until_named(tab, plot.get_by_text("2, bed_2.png: CDR"), across=0.5)
    hover_until_named(tab, plot.get_by_text("3, bed_3.png: CDR"), across=0.9)
    tab.page.mouse.down()
    tab.page.mouse.up()
    on_image(tab, 3)
    selected(tab, uid_of(3, 1))
    choose(tab, "Figures by", "annotator")
    groups = tab.page.get_by_role("table", name="Groups of caps")
    adas = groups.get_by_role("row", name="Ada")
    assert adas.inner_text().split()[3:] == ["12", "3", "3"]
    choose(tab, "Figures by", "light")
    tab.page.get_by_text("Of no image that counts the light is known yet.").wait_for()
    for by in ("form", "size", "visible share", "circle or polygon", "run", "annotator"):
        choose(tab, "Figures by", by)
        expect(adas).to_have_count(1 if by == "annotator" else 0, timeout=30_000)
        rows = groups.locator("tbody").get_by_role("row").all_inner_texts()
        assert sum(int(row.split()[-3]) for row in rows) == 12, "groups add up to the whole"
    adas.get_by_role("button", name="3", exact=True).first.click()
    caps = tab.page.get_by_role("group", name="Caps of all images")
    caps.get_by_text("1–3 of 3. Annotated, and not predicted.").wait_for()
    caps.get_by_text("Only annotator: Ada").wait_for()
    bed_2 = tab.page.locator("tr:has([data-fairyring-by=image])", has_text="bed_2.png")
    bed_2.get_by_role("button", name="1", exact=True).last.click()
    caps.get_by_text("1–1 of 1. Predicted, and not annotated.").wait_for()
    caps.get_by_role("button", name="Show all").click()
    caps.get_by_text("1–3 of 3. Predicted, and not annotated.").wait_for()
    with tab.page.expect_download() as kept:
        plot.get_by_role("link", name="CSV").click()
    rows = kept.value.path().read_text().splitlines()
    assert [row.split(",")[0] for row in rows] == ["image", "bed_1.png", "bed_2.png", "bed_3.png"]
    svg = tab.page.request.get(f"{server.url}/review/shifts.svg").text()
    assert svg.startswith("<svg")
    assert svg.count('class="dot"') == 12
    report = tab.page.request.get(f"{server.url}/review/report.html?image=2").text()
    assert "(Table 4)" in report
    assert "bed_1.png" not in report
