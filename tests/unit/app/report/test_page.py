"""The review as a page: all of it in one file, with what people and networks said drawn over the photos."""

from __future__ import annotations

import base64
import csv
import io
import json
import re
from html import escape
from html.parser import HTMLParser
from pathlib import Path

import cv2
import numpy as np
import pytest
from sqlalchemy import Connection
from typer.testing import CliRunner

from fairyring.app.cli import app
from fairyring.app.report.page import page_of
from fairyring.app.report.pictures import MARKED, PREDICTED, close_ups, side_by_side
from fairyring.app.review.figures import figures_of, review_of, worst_caps
from fairyring.app.review.unmeasured import why_unmeasured
from fairyring.model.errors import FairyringError
from fairyring.storage.journal import commit
from fairyring.storage.predictions import add_predictions, add_run, latest_run
from fairyring.storage.project import Project
from fairyring.storage.records import Verdict
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
    images, caps, _ = (rows_of(address) for address in files)
    assert [row["image"] for row in images] == ["bed_1.jpg"]
    assert {row["cap"]: round(float(row["dx"]), 3) for row in caps} == {"left": 1.6, "right": 0.0}
    assert {row["shape"] for row in caps} <= {"regular", "irregular"}
    assert all(float(row["floor"]) > 0 for row in caps)


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
    assert "nothing to measure" in html
    assert re.search(r"3 images that nobody has worked on", html)


def test_a_report_of_one_image_speaks_of_that_image(project: Project) -> None:
    mark_both(project)
    html = page_of(project, review_of(project, images="bed_1.jpg"))
    assert "<h1>Review of bed_1.jpg</h1>" in html
    assert "Mean CDR by image" not in html
    assert "of all" not in html
    assert "<h1>Review of 3 images of " in page_of(project, review_of(project, images="bed_*"))
    assert f"<h1>Review of {project.name}</h1>" in page_of(project, review_of(project))


def test_of_an_image_that_nobody_has_worked_on_the_report_says_so(project: Project) -> None:
    html = page_of(project, review_of(project, images="bed_2.jpg"))
    assert "Nobody has worked on bed_2.jpg" in html


def test_bars_and_close_ups_name_their_caps_by_the_same_numbers(project: Project) -> None:
    mark_both(project)
    html = page_of(project, review_of(project))
    assert re.findall(r'class="name">([^<]+)<', html) == ["cap 1", "cap 2"]
    assert "bed_1.jpg, cap 1: CDR 1.500\u00a0%" in html


def test_the_report_tells_reasons_and_comments_with_who_and_when(project: Project) -> None:
    mark_both(project)
    for said in (
        Verdict(id="1", image=1, says="sent_back", words="Look <again>."),
        Verdict(id="2", image=1, annotation="right", says="comment", words="Is it one?"),
    ):
        commit(project, [], verdicts=[said], user="Rev")
    review = review_of(project)
    html = page_of(project, review)
    rows = re.findall(r"<td>bed_1.jpg</td><td>([^<]*)</td><td>([^<]*)</td><td>([^<]*)</td><td>Rev</td>", html)
    assert rows == [
        ("the image", "sent back", "Look &lt;again&gt;."),
        ("cap 2", "commented", "Is it one?"),
    ]
    assert re.search(r"<td>bed_1.jpg</td><td[^>]*>sent back</td>", html.split('id="images"')[1])
    assert len(re.findall(r"<td>\d{4}-\d\d-\d\d \d\d:\d\d UTC</td>", html)) == 2
    entries = figures_of(review)["verdicts"]
    assert [(each["by"], each["says"], each.get("annotation")) for each in entries] == [
        ("Rev", "sent_back", None),
        ("Rev", "comment", "right"),
    ]


def test_caps_that_are_marked_but_match_nothing_are_told_from_caps_that_nobody_marked(
    project: Project,
) -> None:
    counts = {"marked": 2, "matched": 0, "missed": 2, "extra": 3}
    assert "None of 2 marked caps matches one of 3 predictions" in why_unmeasured(counts)
    assert "Nothing is predicted" in why_unmeasured(counts | {"extra": 0})
    assert "No cap is marked" in why_unmeasured(counts | {"marked": 0})
    assert "what matches has no mark" in why_unmeasured(counts | {"matched": 1, "marked": 1})
    assert "No cap is labelled" in page_of(project, review_of(project))


def test_the_photo_shows_what_the_chosen_run_said_and_not_the_latest(project: Project) -> None:
    mark_both(project)
    with project.read() as connection:
        first = latest_run(connection)
    assert first is not None
    before = side_by_side(project, 1, run=first)

    def predict_nothing(connection: Connection) -> None:
        run = add_run(connection, name="later", kind="network")
        add_predictions(connection, run_id=run.id, image_id=1, predictions=[])

    project.write(predict_nothing)
    assert side_by_side(project, 1, run=first) == before
    assert side_by_side(project, 1)[1] != before[1]
    html = page_of(project, review_of(project, run=first))
    assert before[1] in html
    assert f"Held against the predictions of {escape(first.name)}." in html


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
