"""The review as a page that the browser prints: with its looks, pictures and plots, none of them cut."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.app.caps.filling_in import fill_in
from fairyring.app.jobs.comparing import compare_work
from fairyring.model.progress import silent
from fairyring.storage.choices import ImportAs
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import open_project
from tests.support.annotated_beds import make_annotated_beds
from tests.support.plain_bed import SIZE, ring

DENSE = 70
A4_PX = (794, 1123)
"""A4 upright at 96 dots an inch."""
WIDER = """
() => [...document.querySelectorAll("body *")].filter(
  (each) => each.getBoundingClientRect().right > document.documentElement.clientWidth + 1).length
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """Two beds of few caps, whose second mark is 8 px off, and a dense one with a mark that is 12 px off."""
    path = make_annotated_beds(tmp_path, count=2)
    photo = tmp_path / "dense.png"
    cv2.imwrite(str(photo), np.full((SIZE[1], SIZE[0], 3), 90, np.uint8))
    places = [(32 + 64 * (nth % 10), 28 + 57 * (nth // 10)) for nth in range(DENSE)]
    marked, predicted = tmp_path / "marked.json", tmp_path / "predicted.json"
    for file, offs, score in (
        (marked, [12.0, *(0.5, -0.5) * DENSE], {}),
        (predicted, [0.0] * DENSE, {"score": 0.9}),
    ):
        caps = [
            {"id": nth, "image_id": 1, "category_id": 1, "segmentation": [ring(x, y, 20.0)]}
            | {"circle": [x + off, y + off / 4, 20.0]}
            | score
            for nth, ((x, y), off) in enumerate(zip(places, offs, strict=False), start=1)
        ]
        image = {"id": 1, "file_name": photo.name, "width": SIZE[0], "height": SIZE[1]}
        categories = [{"id": 1, "name": "mushroom"}]
        file.write_text(json.dumps({"images": [image], "annotations": caps, "categories": categories}))
    with open_project(path) as opened:
        import_paths(opened, [photo, marked])
        import_paths(opened, [predicted], as_=ImportAs.predictions)
        fill_in(opened)
        compare_work(opened)(silent)
    return path


def test_the_report_is_printed_with_its_pictures_and_nothing_beyond_the_paper(
    server: Server, open_tab: Callable[..., Tab]
) -> None:
    tab = open_tab(server, name="Rev")
    tab.page.get_by_role("tab", name="Review").click()
    cloud = tab.page.get_by_role("group", name="Predicted minus marked centre, px")
    cloud.get_by_text("1 lies further out.").wait_for()  # of the bed that the latest run saw
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
    page.get_by_text("3 lie further out.").wait_for()
    assert page.locator(".spread").count() == 1
    for told in ("(Table 2)", "(Table 3)", "(Table 4)", "mean error, px", "error / diameter, %"):
        page.get_by_text(told).first.wait_for()
    of_each_cap = page.locator("figure", has_text="dense.png: CDR of each cap")
    bars = [told.split(":")[0] for told in of_each_cap.locator("title").all_text_contents()]
    assert bars == [f"cap {nth}" for nth in range(1, DENSE + 1)], "more than stand in one row"
    assert of_each_cap.locator("svg").count() == 2
    for kept_whole in ("figure", "tr", "svg"):
        of_it = f"getComputedStyle(document.querySelector({kept_whole!r})).breakInside"
        assert page.evaluate(of_it) == "avoid"
    printed = page.pdf(format="A4")
    assert printed.startswith(b"%PDF")
    different = page.evaluate("new Set([...document.images].map((each) => each.src)).size")
    assert printed.count(b"/Subtype /Image") >= different
    page.close()
