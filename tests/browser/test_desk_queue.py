"""A reviewer goes through a queue of images, or a sample that speaks for a lot."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from tests.support.annotated_beds import make_annotated_beds
from tests.support.desk import choose, on_image, said_of, say_yes, status_of
from tests.support.forked import forked_server

OpenTab = Callable[..., Tab]


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_annotated_beds(tmp_path, count=3)


def open_queue(tab: Tab) -> None:
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_text("Queue", exact=True).click()


def test_a_queue_is_gone_through_with_the_agreement_and_taken_up_again_after_a_reload(
    server: Server, open_tab: OpenTab
) -> None:
    tab = open_tab(server, name="Rev")
    open_queue(tab)
    tab.page.get_by_text("3 images wait for a review.").wait_for()
    choose(tab, "Queue by", "edited since approved")
    tab.page.get_by_text("No image fits this queue").wait_for()
    for order in ("CDR over its floor", "least overlap", "most missed", "most extra", "network least sure"):
        choose(tab, "Queue by", order)
        tab.page.get_by_text("3 images fit this queue.").wait_for()
    choose(tab, "Annotator", "Ada")
    tab.page.get_by_text("3 images fit this queue.").wait_for()
    tab.page.get_by_role("button", name="Begin").click()
    tab.page.get_by_text("0 of 3 done").wait_for()
    tab.press("Shift+Enter")
    say_yes(tab)
    on_image(tab, 2)
    tab.press("Shift+X")
    tab.page.keyboard.type("Out of focus")
    tab.press("Enter")
    on_image(tab, 3)
    # Wilson's interval of 1 in 2.
    tab.page.get_by_text("2 of 3 done, agreement 50 % (9 to 91 %)").wait_for()
    tab.page.reload()
    tab.wait_for("window.fairyring?.state.connection === 'online'")
    tab.page.get_by_role("tab", name="Review").click()
    tab.page.get_by_text("2 of 3 done, agreement 50 % (9 to 91 %)").wait_for()
    tab.page.get_by_role("button", name="End the queue").click()
    tab.page.get_by_text("1 image waits for a review.").wait_for()


def test_a_random_sample_that_passes_has_the_rest_approved(tmp_path: Path, browser: Browser) -> None:
    (tmp_path / "lot").mkdir()
    project = make_annotated_beds(tmp_path / "lot", count=12)
    server = forked_server(project)
    server.start()
    context = browser.new_context(viewport={"width": 1500, "height": 900})
    try:
        tab = Tab(context.new_page())
        tab.enter(server.url, name="Rev")
        open_queue(tab)
        choose(tab, "Queue by", "random sample")
        tab.page.get_by_text("12 of 12 images have to be looked at").wait_for()
        tab.page.get_by_label("Wrong at most %").fill("40")
        tab.press("Tab")
        # Five wrong of twelve: scipy.stats.hypergeom(12, 5, 5).cdf(0) is 0.027, of 4 it is 0.071.
        tab.page.get_by_text("5 of 12 images have to be looked at").wait_for()
        tab.page.get_by_role("button", name="Begin").click()
        tab.page.get_by_text("0 of 5 done").wait_for()
        for done in range(1, 6):
            tab.press("Shift+Enter")
            say_yes(tab)
            tab.page.locator(".fr-queue").get_by_text(f"{done} of 5 done").wait_for()
        tab.page.get_by_role("button", name="Approve the other 7").click()
        tab.page.get_by_text("7 images approved.").wait_for()
    finally:
        context.close()
        server.stop()
    assert [status_of(project, number) for number in range(1, 13)] == ["approved"] * 12
    words = {v.words for number in range(1, 13) for v in said_of(project, number)}
    assert words == {"", "By a sample: 0 of 5 wrong, 0 allowed"}
