"""The review as a page: all of it in one file, with what people and networks said drawn over the photos."""

from __future__ import annotations

import base64
import csv
import io
import json
import re
from html.parser import HTMLParser
from pathlib import Path

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

from fairyring.app.cli import app
from fairyring.app.report.page import page_of
from fairyring.app.report.pictures import MARKED, PREDICTED, close_ups
from fairyring.app.review.figures import review_of, worst_caps
from fairyring.model.errors import FairyringError
from fairyring.storage.project import Project
from tests.support.two_marked import mark_both


class Addresses(HTMLParser):
    """Everything that a page would load or lead to."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []
        self.tags: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.found += [value for name, value in attrs if name in ("src", "href") and value]


def read_page(project: Project) -> Addresses:
    page = Addresses()
    page.feed(page_of(project, review_of(project)))
    return page


def rows_of(address: str) -> list[dict[str, str]]:
    """The rows of a table that an address holds."""
    return list(csv.DictReader(io.StringIO(base64.b64decode(address.split(",")[1]).decode())))


def share_drawn(picture: np.ndarray, centre: tuple[float, float], colour: tuple[int, int, int]) -> float:
    """Of how many places of a circle of 80 px around a centre the picture has this colour nearby."""
    turns = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    places = np.rint(np.add(centre, 80 * np.stack([np.cos(turns), np.sin(turns)], axis=1))).astype(int)
    near = [picture[y - 2 : y + 3, x - 2 : x + 3].reshape(-1, 3) for x, y in places]
    return float(np.mean([np.abs(pixels - colour).sum(axis=1).min() < 150 for pixels in near]))


def test_the_page_loads_nothing_and_no_name_is_read_as_html(project: Project) -> None:
    mark_both(project)
    page = read_page(project)
    assert all(address.startswith("data:") for address in page.found)
    # The photo three times, a close-up of each of two measured caps, and none of a file's name.
    assert page.tags.count("img") == 5
    assert "script" not in page.tags


def test_the_tables_to_download_hold_every_measured_cap(project: Project) -> None:
    mark_both(project)
    files = [address for address in read_page(project).found if address.startswith("data:text/csv")]
    images, caps = (rows_of(address) for address in files)
    assert [row["image"] for row in images] == ["bed_1.jpg"]
    assert {row["cap"]: round(float(row["dx"]), 3) for row in caps} == {"left": 1.6, "right": 0.0}


def test_a_close_up_shows_the_marked_and_the_predicted_outline(project: Project) -> None:
    mark_both(project)
    addresses = close_ups(project, worst_caps(review_of(project).caps))
    data = np.frombuffer(base64.b64decode(addresses[0].split(",")[1]), np.uint8)
    picture = cv2.imdecode(data, cv2.IMREAD_COLOR).astype(int)
    # It shows 60 px of the photo on 240: 20 px are 80 there, and the prediction lies 1.6 and .6 px off.
    assert share_drawn(picture, (120, 120), MARKED) > 0.9
    assert share_drawn(picture, (120 + 4 * 1.6, 120 - 4 * 0.6), PREDICTED) > 0.9
    assert share_drawn(picture, (120, 120), (0, 255, 0)) < 0.5


def test_a_photo_that_is_gone_leaves_its_caps_in_the_page(project: Project) -> None:
    mark_both(project)
    next((project.folder / "images").glob("bed_1*")).unlink()
    html = page_of(project, review_of(project))
    assert html.count("The photo is gone.") == 2


def test_a_project_without_marks_has_a_page_that_says_so(project: Project) -> None:
    html = page_of(project, review_of(project))
    assert "nothing to plot" in html
    assert re.search(r"3 images that nobody has worked on", html)


@pytest.fixture
def ended(project: Project) -> Path:
    mark_both(project)
    project.close()
    return project.folder


def test_the_command_prints_figures_and_writes_the_page(ended: Path, tmp_path: Path) -> None:
    out = tmp_path / "review.html"
    found = CliRunner().invoke(app, ["review", str(ended), "--json", "--report", str(out)])
    assert found.exit_code == 0, found.output
    assert json.loads(found.stdout)["matched"] == 2
    assert out.read_text().startswith("<!doctype html>")


def test_a_page_that_cannot_be_written_is_refused_in_a_sentence(ended: Path, tmp_path: Path) -> None:
    found = CliRunner().invoke(app, ["review", str(ended), "--report", str(tmp_path / "no" / "review.html")])
    assert isinstance(found.exception, FairyringError)
    assert "cannot be written" in str(found.exception)
