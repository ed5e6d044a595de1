"""Predictions of methods that need no weights."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from fairyring.model.colour.methods import METHODS
from fairyring.storage.project import Project
from tests.support.stored import stored_runs
from tests.unit.app.jobs.test_predicting import fairyring, state


@pytest.mark.parametrize("method", METHODS)
def test_a_run_says_which_method_it_is_and_goes_on_where_it_stopped(project: Project, method: str) -> None:
    done = fairyring("predict", project.folder, "--method", method, "--json")
    assert done.exit_code == 0, done.output
    assert json.loads(done.stdout)["images"] == 3
    with project.read() as connection:
        run, *_ = stored_runs(connection)
    assert (run.name, run.weights, run.settings) == (method, None, {"method": method})
    before = state(project)
    again = fairyring("predict", project.folder, "--method", method, "--json")
    assert json.loads(again.stdout)["known"] == 3
    assert state(project) == before


def test_another_diameter_makes_another_run(project: Project) -> None:
    for diameter in (40, 60):
        done = fairyring("predict", project.folder, "--method", "hough", "--diameter", diameter)
        assert done.exit_code == 0, done.output
    with project.read() as connection:
        last, first, *_ = stored_runs(connection)
    assert [run.settings["diameter"] for run in (first, last)] == [40, 60]


def test_such_a_method_takes_no_weights(project: Project, tmp_path: Path) -> None:
    before = state(project)
    for words in (("--weights", tmp_path / "some.safetensors"), ("--fast",)):
        assert fairyring("predict", project.folder, "--method", "corners", *words).exit_code == 2
    assert state(project) == before


def test_photos_without_a_project_are_predicted_so_too(project: Project, tmp_path: Path) -> None:
    out = tmp_path / "found.json"
    photo = project.images / "bed_1.jpg"
    done = fairyring("predict", photo, "--out", out, "--method", "watershed", "--diameter", 40)
    assert done.exit_code == 0, done.output
    info = json.loads(out.read_text())["info"]
    assert info["settings"] == {"method": "watershed", "diameter": 40.0}
