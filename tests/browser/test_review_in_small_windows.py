"""The review in a small window: nothing of it is cut, and nothing has to be scrolled sideways."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import expect

from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.app.jobs.comparing import compare_with_run_work
from fairyring.model.progress import silent
from fairyring.storage.choices import ImportAs
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import open_project
from fairyring.storage.runs import all_runs
from tests.support.annotated_beds import PLACES, RADIUS, make_annotated_beds
from tests.support.choosing import choose
from tests.support.plain_bed import SIZE, ring

LONG = "what_ben_labelled_in_the_autumn_of_the_second_year.json"
FOLDERS = ("Queue", "Rules of this project", "Two runs side by side", "Two annotators")
SCROLLED_SIDEWAYS = """
() => [...document.querySelectorAll(".mantine-ScrollArea-viewport")]
  .filter((each) => each.scrollWidth > each.clientWidth).length
"""
CUT = """
() => [...document.querySelectorAll(".fr-review, .fr-review *")]
  .filter((each) => each.clientWidth > 0 && each.scrollWidth > each.clientWidth + 1)
  .map((each) => `${each.tagName} ${each.textContent.slice(0, 40)}`)
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """Two photos, compared with a network's predictions and with a file of Ben's that has a long name."""
    path = make_annotated_beds(tmp_path, count=2)
    images = [{"id": n, "file_name": f"bed_{n}.png", "width": SIZE[0], "height": SIZE[1]} for n in (1, 2)]
    caps = [
        {"id": 10 * image + n, "image_id": image, "category_id": 1}
        | {"segmentation": [ring(x, y, RADIUS)], "circle": [x + n, y, RADIUS]}
        for image in (1, 2)
        for n, (x, y) in enumerate(PLACES)
    ]
    document = {"images": images, "annotations": caps, "categories": [{"id": 1, "name": "mushroom"}]}
    (tmp_path / LONG).write_text(json.dumps(document))
    with open_project(path) as opened:
        import_paths(opened, [tmp_path / LONG], as_=ImportAs.second)
        with opened.read() as connection:
            runs = all_runs(connection)
        for run in runs:
            compare_with_run_work(opened, run)(silent)
    return path


@pytest.mark.parametrize(("width", "height"), [(1024, 768), (1366, 768)])
def test_nothing_is_cut_and_nothing_is_to_be_scrolled_sideways(
    server: Server, open_tab: Callable[..., Tab], *, width: int, height: int
) -> None:
    tab = open_tab(server, name="Rev")
    tab.page.set_viewport_size({"width": width, "height": height})
    tab.page.get_by_role("tab", name="Review").click()
    for folder in FOLDERS:
        tab.page.get_by_text(folder, exact=True).first.click()
    choose(tab, "Figures by", "annotator")
    choose(tab, "First run", "instances.json")
    choose(tab, "Second run", LONG)
    choose(tab, "Second annotator", LONG)
    for table in ("Groups of caps", "Two runs side by side", "Images of two annotators"):
        tab.page.get_by_role("table", name=table).wait_for()
    tab.page.get_by_role("link", name="Report of all images against").wait_for()
    assert tab.page.evaluate(CUT) == []
    assert tab.page.evaluate(SCROLLED_SIDEWAYS) == 0
    for field in ("Second annotator", "Second run", "On the photo"):
        chosen = tab.page.get_by_role("combobox", name=field, exact=True)
        chosen.hover()
        expect(chosen).to_have_attribute("title", LONG)
        assert chosen.evaluate("field => getComputedStyle(field).textOverflow") == "ellipsis"
