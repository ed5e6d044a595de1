"""The review as a page that the browser prints: with its looks, pictures and plots, none of them cut."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from tests.support.annotated_beds import make_annotated_beds

A4_PX = (794, 1123)
"""A4 upright at 96 dots an inch."""
WIDER = """
() => [...document.querySelectorAll("body *")].filter(
  (each) => each.getBoundingClientRect().right > document.documentElement.clientWidth + 1).length
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_annotated_beds(tmp_path, count=2)


def test_the_report_is_printed_with_its_pictures_and_nothing_beyond_the_paper(
    server: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(server, name="Rev")
    page = tab.page.context.new_page()
    refused: list[str] = []
    page.on("console", lambda said: refused.append(said.text))
    page.goto(f"{server.url}/review/report.html")
    assert refused == []
    page.emulate_media(media="print")
    page.set_viewport_size({"width": A4_PX[0], "height": A4_PX[1]})
    pictures = page.locator("img")
    assert pictures.count() > 6
    assert all(page.evaluate("[...document.images].map((each) => each.naturalWidth > 0)"))
    assert page.evaluate("getComputedStyle(document.querySelector('dl')).display") == "flex"
    assert page.evaluate(WIDER) == 0
    for kept_whole in ("figure", "tr", "svg"):
        of_it = f"getComputedStyle(document.querySelector({kept_whole!r})).breakInside"
        assert page.evaluate(of_it) == "avoid"
    printed = page.pdf(format="A4")
    assert printed.startswith(b"%PDF")
    different = page.evaluate("new Set([...document.images].map((each) => each.src)).size")
    assert printed.count(b"/Subtype /Image") >= different
    page.close()
