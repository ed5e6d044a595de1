"""Runs in a terminal: listed, shown, renamed, compared and exported by name."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from pycocotools.coco import COCO

from fairyring.model.geometry.shapes import Circle, fit_of_shape
from fairyring.storage.journal import Derived, commit
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.project import create_project
from fairyring.storage.records import Cap, Edit
from tests.support.terminal import fairyring, sentence
from tests.unit.storage.conftest import write_noise

SQUARE = [10.0, 10.0, 30.0, 10.0, 30.0, 30.0, 10.0, 30.0]


@pytest.fixture
def beds(tmp_path: Path) -> Path:
    """A photo with one marked cap at (20, 20), which two runs saw at 22 and at 21."""
    photo = write_noise(tmp_path / "bed.png")
    folder = tmp_path / "beds"
    with create_project(folder) as project:
        from fairyring.storage.importing.paths import import_paths

        import_paths(project, [photo])
        edit = Edit(
            id="e", annotation="a", image=1, base=0, cap=Cap(visible=[SQUARE], mark=Circle(20, 20, 10))
        )
        commit(project, [Derived(edit=edit, fit=fit_of_shape(Circle(20, 20, 10)))], user="ann")
        for name, x in (("old", 22.0), ("new", 21.0)):

            def predict(connection, name=name, x=x):
                run = add_run(connection, name=name, kind="network", weights="ab" * 32)
                said = NewPrediction(visible=[SQUARE], score=0.75, fit=fit_of_shape(Circle(x, 20, 10)))
                add_predictions(connection, run_id=run.id, image_id=1, predictions=[said])

            project.write(predict)
    return folder


def test_they_are_listed_and_shown(beds: Path) -> None:
    listed = json.loads(fairyring("runs", "list", beds, "--json").stdout)
    assert [(run["number"], run["name"], run["images"], run["latest_of"]) for run in listed] == [
        (1, "old", 1, 0),
        (2, "new", 1, 1),
    ]
    shown = json.loads(fairyring("runs", "show", beds, "old", "--json").stdout)
    assert (shown["weights"], shown["files"]) == ("ab" * 32, ["bed.png"])
    assert "weights: abab" in fairyring("runs", "show", beds, "1").stdout


def test_one_gets_another_name(beds: Path) -> None:
    assert "old is called before now" in fairyring("runs", "rename", beds, "old", "before").stderr
    assert "before" in fairyring("runs", "list", beds).stdout
    assert fairyring("runs", "rename", beds, "before", "new").exit_code == 1


def test_two_are_compared_with_what_people_marked(beds: Path) -> None:
    figures = json.loads(fairyring("runs", "compare", beds, "old", "new", "--json").stdout)
    assert (figures["first"]["px"]["mean"], figures["second"]["px"]["mean"]) == (2.0, 1.0)
    assert figures["difference"]["px"]["mean"] == -1.0
    assert "the second is nearer in 1" in fairyring("runs", "compare", beds, "old", "new").stdout


def test_one_is_exported_by_name_with_results_that_pycocotools_loads(beds: Path, tmp_path: Path) -> None:
    results = tmp_path / "results.json"
    told = fairyring("export", beds, tmp_path / "out", "--run", "old", "--results", results)
    assert "Predictions of old (1 image)" in told.stderr
    truth = COCO(str(tmp_path / "out" / "instances.json"))
    loaded = truth.loadRes(str(results))
    (result,) = loaded.loadAnns(loaded.getAnnIds())
    assert (result["score"], result["image_id"], result["area"]) == (0.75, 1, 400)
    assert result["bbox"] == [10, 10, 20, 20]
    assert loaded.annToMask(result)[10:30, 10:30].all()


@pytest.mark.parametrize(
    "options", [("--run", "old", "--only", "approved"), ("--only", "all", "--results", "r.json")]
)
def test_what_writes_no_predictions_is_refused(beds: Path, tmp_path: Path, options: tuple[str, ...]) -> None:
    assert fairyring("export", beds, tmp_path / "out", *options).exit_code == 2
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("runs", "rename", "beds", "old", ""), "this is empty"),
        (("runs", "rename", "beds", "old", "x" * 300), "has 300"),
        (("import", "beds", "photo.png", "--by", ""), "this is empty"),
        (("take-out", "beds", "bed.png", "--by", "two\nlines"), "has others"),
        (("predict", "beds", "--name", ""), "this is empty"),
    ],
)
def test_a_name_that_is_none_is_wrong_use(words: tuple[str, ...], reason: str) -> None:
    told = fairyring(*words)
    assert told.exit_code == 2
    assert "1 to 200 printable characters" in told.stderr
    assert reason in told.stderr


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("runs", "compare", "{}", "old", "1"), "Both are old, which is one run"),
        (("review", "{}", "--run", "2", "--against", "new"), "Both are new, which is one run"),
        (("review", "{}", "--against", "new"), "Both are new, which is one run"),
        (
            ("review", "{}", "--run", " "),
            "A run has a name or a number, and none was given. The latest are new",
        ),
        (("review", "{}", "--images", "zzz*"), "The project has no image called zzz*."),
    ],
)
def test_what_cannot_be_compared_is_refused_in_a_sentence(
    beds: Path, words: tuple[str, ...], reason: str
) -> None:
    assert reason in sentence(fairyring(*(word.format(beds) for word in words)))
