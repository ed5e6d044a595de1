from __future__ import annotations

import gzip
import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from fairyring.app.cli import app
from fairyring.model.errors import FileError
from tests.support.terminal import fairyring


def bed(*corners: int, **annotation: Any) -> dict[str, Any]:
    """Caps of 40 × 40 px with these left upper corners."""
    squares = [[[x, 0, x + 40, 0, x + 40, 40, x, 40]] for x in corners]
    return {
        "images": [{"id": 1, "file_name": "a.png", "width": 400, "height": 100, "light": "dark"}],
        "annotations": [
            {"id": x, "image_id": 1, "segmentation": s, **annotation}
            for x, s in zip(corners, squares, strict=True)
        ],
    }


@pytest.fixture
def truth(tmp_path: Path) -> Path:
    path = tmp_path / "truth.json"
    path.write_text(json.dumps(bed(0, 100, 200)))
    return path


@pytest.fixture
def predicted(tmp_path: Path) -> Path:
    """A gzipped list of results, as a model writes it."""
    path = tmp_path / "predicted.json.gz"
    path.write_bytes(gzip.compress(json.dumps(bed(0, 100, 300, score=0.75)["annotations"]).encode()))
    return path


def invoke(*arguments: object) -> Any:
    return CliRunner().invoke(app, ["evaluate", *map(str, arguments)])


def test_masks_are_compared_with_the_truth(predicted: Path, truth: Path) -> None:
    told = invoke("masks", predicted, truth, "--json")

    assert told.exit_code == 0
    figures = json.loads(told.stdout)
    assert (figures["P"], figures["R"], figures["S50"]) == (2 / 3, 2 / 3, 2 / 3)
    assert figures["groups"]["light"]["dark"]["count"] == 3


def test_the_figures_are_shown_as_tables(predicted: Path, truth: Path) -> None:
    told = invoke("masks", predicted, truth)

    assert told.exit_code == 0
    assert "S50_strict" in told.stdout
    assert "0.6667" in told.stdout
    assert "2 matched, 1 missed, 1 extra" in told.stdout
    assert "score ≥ 0.750" in told.stdout


def test_nothing_predicted_is_shown_too(truth: Path, tmp_path: Path) -> None:
    (tmp_path / "nothing.json").write_text("[]")

    assert "0 matched, 3 missed" in invoke("masks", tmp_path / "nothing.json", truth).stdout


@pytest.mark.parametrize("command", ["masks", "centres"])
def test_the_file_that_is_wrong_is_named_and_the_other_is_not(
    command: str, truth: Path, tmp_path: Path
) -> None:
    wrong = tmp_path / "wrong.json"
    wrong.write_text(json.dumps(bed(0, score=float("nan"))))

    refused = invoke(command, wrong, truth)

    assert refused.exit_code == 1
    assert isinstance(refused.exception, FileError)
    assert str(refused.exception).startswith(
        f"{wrong}: Annotation 0 of a.png: Its score is not a finite number"
    )
    assert str(invoke(command, truth, wrong).exception).startswith(f"{wrong}: ")


def test_files_that_do_not_fit_together_are_both_named(truth: Path, tmp_path: Path) -> None:
    other = bed(0)
    other["images"][0]["width"] = 300
    (tmp_path / "other.json").write_text(json.dumps(other))

    refused = str(invoke("masks", tmp_path / "other.json", truth).exception)

    assert refused.startswith(f"{tmp_path / 'other.json'} or {truth}: a.png has different sizes")


def test_a_missing_file_is_named(truth: Path, tmp_path: Path) -> None:
    assert "nowhere.json cannot be read" in str(invoke("masks", tmp_path / "nowhere.json", truth).exception)


def test_every_evaluation_says_how_it_is_used() -> None:
    for command in ("masks", "centres"):
        assert f"fairyring evaluate {command}" in invoke(command, "--help").stdout


def test_ids_that_are_of_other_caps_are_told(tmp_path: Path) -> None:
    def file(name: str, *places: float) -> Path:
        annotations = [
            {"id": n, "image_id": 1, "circle": [x + 10, 15, 10]} for n, x in enumerate(places, start=1)
        ]
        image = {"id": 1, "file_name": "a.jpg", "width": 200, "height": 100}
        path = tmp_path / name
        path.write_text(json.dumps({"images": [image], "annotations": annotations}))
        return path

    truth, renumbered = file("truth.json", 5, 50, 100), file("said.json", 100, 5, 50)
    told = fairyring("evaluate", "centres", renumbered, truth, "--by", "id")
    assert "Of 3 caps paired by id 3 lie further apart" in told.stderr
    assert "further apart" not in fairyring("evaluate", "centres", truth, truth, "--by", "id").stderr


def centred(path: Path, *shifts: float | None) -> Path:
    """Caps of the truth whose centres are off by so many pixels; None leaves one out."""
    document = bed(0, 100, 200)
    document["annotations"] = [
        annotation | {"center": [annotation["id"] + 20 + shift, 20]}
        for annotation, shift in zip(document["annotations"], shifts, strict=True)
        if shift is not None
    ]
    path.write_text(json.dumps(document))
    return path


def test_two_runs_are_compared_in_pairs(tmp_path: Path) -> None:
    truth = centred(tmp_path / "truth.json", 0, 0, 0)
    first, second = centred(tmp_path / "a.json", 2, 4, 1), centred(tmp_path / "b.json", 1, 1, None)

    figures = json.loads(invoke("centres", first, second, truth, "--json").stdout)

    assert figures["first"]["px"]["mean"] == pytest.approx(7 / 3)
    assert (figures["second"]["matched"], figures["second"]["missed"]) == (2, 1)
    assert figures["difference"]["px"]["mean"] == -2.0
    shown = invoke("centres", first, second, truth).stdout
    assert "Of 2 caps the second is nearer in 2, the first in 0; 1 were found by the first alone" in shown


def test_centres_of_one_run_come_with_a_row_a_cap_and_groups(tmp_path: Path) -> None:
    truth, said = centred(tmp_path / "t.json", 0, 0, 0), centred(tmp_path / "s.json", 3, None, 5)

    figures = json.loads(invoke("centres", said, truth, "--json").stdout)

    assert [(cap["truth"], cap["outcome"], cap["dx"]) for cap in figures["caps"]] == [
        (0, "matched", 3.0),
        (200, "matched", 5.0),
        (100, "missed", None),
    ]
    assert figures["groups"]["light"]["dark"]["missed"] == 1
    assert "dark" in invoke("centres", said, truth).stdout


def test_least_overlap_and_score_are_asked_for(predicted: Path, truth: Path) -> None:
    def matched(*options: str) -> int:
        return json.loads(invoke("centres", predicted, truth, "--json", *options).stdout)["matched"]

    assert (matched(), matched("--score", "0.75"), matched("--score", "0.76")) == (2, 2, 0)
    assert matched("--iou", "1") == 2


def test_what_cannot_be_meant_is_wrong_use(truth: Path) -> None:
    alone, overlap = invoke("centres", truth), invoke("centres", truth, truth, "--by", "id", "--iou", "0.7")
    assert (alone.exit_code, overlap.exit_code) == (2, 2)
    assert "last the truth" in alone.stderr
    assert "no mask is read" in overlap.stderr


@pytest.mark.parametrize("what", ["masks", "centres"])
def test_files_in_the_wrong_order_are_told(what: str, truth: Path, tmp_path: Path) -> None:
    predicted = tmp_path / "predicted.json"
    predicted.write_text(json.dumps(bed(0, 100, score=0.75)))
    assert "have they been swapped?" in invoke(what, truth, predicted).stderr
    for right in ((predicted, truth), (truth, truth), (predicted, predicted)):
        assert "swapped" not in invoke(what, *right).stderr


def test_ids_that_no_image_has_in_both_files_are_told(tmp_path: Path) -> None:
    for name, shift in (("a.json", 0), ("b.json", 1)):
        document = bed(0, 100)
        for annotation in document["annotations"]:
            annotation["id"] += shift
        (tmp_path / name).write_text(json.dumps(document))
    told = invoke("centres", tmp_path / "a.json", tmp_path / "b.json", "--by", "id")
    assert "0 matched" in told.stdout
    assert "No image has an id in both files" in told.stderr
