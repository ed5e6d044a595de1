"""Two runs side by side: the figures of both, and the caps that changed most."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from fairyring.app.jobs.comparing import compare_with_run_work, compare_work
from fairyring.app.panels.beside import find_beside
from fairyring.app.report.page import page_of
from fairyring.app.review.figures import review_of
from fairyring.app.review.two_runs import reviews_of_both, side_by_side
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.shapes import Circle, fit_of_shape
from fairyring.model.progress import silent
from fairyring.storage.compared_runs import lacking_comparison
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run, latest_run
from fairyring.storage.project import Project, open_project
from fairyring.storage.records import Run
from fairyring.storage.runs import get_run
from tests.support.annotated_beds import CDR, PLACES, RADIUS, SHIFT, make_annotated_beds
from tests.support.plain_bed import ring
from tests.support.terminal import fairyring


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two photos that the first run saw; a later one saw the first photo, and had its second cap right."""
    path = make_annotated_beds(tmp_path, count=2)
    with open_project(path) as project:
        project.write(_see_better)
    return path


def _see_better(connection) -> None:
    run = add_run(connection, name="after", kind="network")
    caps = []
    for number, (x, y) in enumerate(PLACES[:4]):
        fit = fit_of_shape(Circle(x + (SHIFT if number == 1 else 0.0), y, RADIUS))
        caps.append(NewPrediction(visible=[ring(x, y, RADIUS)], score=0.9, uid=f"p{number}", fit=fit))
    add_predictions(connection, run_id=run.id, image_id=1, predictions=caps)


def both(project: Project) -> tuple[Run, Run]:
    with project.read() as connection:
        after = latest_run(connection)
        assert after is not None
        return get_run(connection, 1), after


def test_both_are_measured_on_the_images_that_both_saw(folder: Path) -> None:
    with open_project(folder) as project:
        first, second = both(project)
        found = side_by_side(*reviews_of_both(project, first, second))
    assert found["images"] == 1
    assert found["first"]["cdr"]["mean"] == pytest.approx(CDR / 4, abs=0.01)
    assert found["second"]["cdr"]["mean"] == pytest.approx(0.0, abs=0.03)
    assert (found["first"]["extra"], found["second"]["extra"]) == (1, 0)
    assert found["difference"]["px"]["mean"] == pytest.approx(-SHIFT / 4, abs=0.2)
    assert found["changed"][0]["cap"] == "cap-1-1"
    assert found["changed"][0]["first"]["px"] == pytest.approx(SHIFT, abs=0.1)


def test_the_command_and_the_page_put_them_side_by_side(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "review.html"
    done = fairyring("review", folder, "--against", 1, "--report", out, "--json")
    figures = json.loads(done.stdout)
    assert figures["side_by_side"]["second"]["run"] == "after"
    assert figures["matched"] == 4
    page = out.read_text()
    assert "Two runs side by side" in page
    assert "Of 4 caps that both found" in page


def test_a_run_and_a_set_of_images_can_be_chosen(folder: Path) -> None:
    of_first = json.loads(fairyring("review", folder, "--run", 1, "--json").stdout)
    assert (len(of_first["images"]), of_first["matched"]) == (2, 8)
    of_one = json.loads(fairyring("review", folder, "--run", 1, "--images", "bed_2*", "--json").stdout)
    assert [image["file_name"] for image in of_one["images"]] == ["bed_2.png"]


def test_runs_without_an_image_in_common_are_refused(folder: Path) -> None:
    with open_project(folder) as project:
        first, _ = both(project)
        other = project.write(lambda connection: add_run(connection, name="blind", kind="network"))
        with pytest.raises(FairyringError, match="both"):
            reviews_of_both(project, first, other)


def test_a_report_of_one_image_holds_the_tables_of_the_paper_and_its_caps_one_by_one(folder: Path) -> None:
    with open_project(folder) as project:
        page = page_of(project, review_of(project, among={1}))
    for words in ("(Table 2)", "(Table 3)", "(Table 4)", "bed_1.png: CDR of each cap"):
        assert words in page
    assert "bed_2.png" not in page


def test_the_desk_has_both_side_by_side_once_the_earlier_one_was_compared_too(folder: Path) -> None:
    with open_project(folder) as project:
        first, second = both(project)
        compare_work(project)(silent)
        with project.read() as connection:
            assert lacking_comparison(connection, first.id) == [1, 2]
        compare_with_run_work(project, first)(silent)
        with project.read() as connection:
            found = find_beside(connection, chosen=first.name)
            assert lacking_comparison(connection, first.id) == []
            turned = find_beside(connection, chosen=second.name, against=first.name)
            alone = find_beside(connection, chosen=first.name, against=first.name)
    assert (found.before, found.after, list(found.lacking)) == (first, second, [])
    assert (turned.before, turned.after) == (second, first)
    assert turned.both is not None
    assert turned.both.second.cdr == pytest.approx(CDR / 4, abs=0.01)
    assert (alone.both, sorted(alone.runs)) == (None, sorted([first.name, second.name]))
    assert found.both is not None
    assert found.both.images == 1
    assert found.both.first.cdr == pytest.approx(CDR / 4, abs=0.01)
    assert found.both.second.cdr == pytest.approx(0.0, abs=0.03)
    assert found.changed[0].annotation == "cap-1-1"
    assert found.changed[0].before == pytest.approx(CDR, abs=0.03)
