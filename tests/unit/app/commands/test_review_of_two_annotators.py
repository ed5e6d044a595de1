"""``fairyring review --second``: the annotations of a project, and what somebody else labelled there."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from fairyring.storage.choices import ImportAs
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import create_project
from tests.support.terminal import fairyring, sentence


def square(number: int, x: float, **keys: Any) -> dict[str, Any]:
    """A cap of 20 × 20 px with its left edge at x and its centre marked in its middle."""
    outline = [x, 10.0, x + 20, 10.0, x + 20, 30.0, x, 30.0]
    own = {"id": number, "image_id": 1, "category_id": 1, "segmentation": [outline]}
    return own | {"circle": [x + 10, 20.0, 10.0]} | keys


def write(path: Path, caps: list[dict[str, Any]], *, photos: tuple[str, ...] = ("bed.png",)) -> Path:
    """The caps are those of the first photo."""
    size = {"width": 200, "height": 100}
    images = [{"id": nth, "file_name": name} | size for nth, name in enumerate(photos, start=1)]
    categories = [{"id": 1, "name": "mushroom"}]
    path.write_text(json.dumps({"images": images, "annotations": caps, "categories": categories}))
    return path


@pytest.fixture
def bens(tmp_path: Path) -> Path:
    """Ben has the first cap, the second 5 px further right, the third as one that counts, and his own."""
    return write(
        tmp_path / "ben.json", [square(7, 10.0), square(8, 55.0), square(9, 100.0), square(10, 175.0)]
    )


@pytest.fixture
def folder(tmp_path: Path, bens: Path) -> Path:
    """Ann ignores the third; the fourth is hers alone. A second photo is hers alone, too."""
    for name in ("bed.png", "other.png"):
        cv2.imwrite(str(tmp_path / name), np.full((100, 200, 3), len(name) * 10, np.uint8))
    caps = [square(1, 10.0), square(2, 50.0), square(3, 100.0, ignored=True), square(4, 150.0)]
    anns = write(tmp_path / "ann.json", caps)
    others = write(tmp_path / "others.json", [square(1, 10.0)], photos=("other.png",))
    project = create_project(tmp_path / "project")
    import_paths(project, [tmp_path / "bed.png", tmp_path / "other.png", anns, others])
    import_paths(project, [bens], as_=ImportAs.second)
    project.close()
    return tmp_path / "project"


def test_with_the_others_file_all_caps_and_flags_are_compared(folder: Path, bens: Path) -> None:
    found = json.loads(fairyring("review", folder, "--second", bens, "--json").stdout)["two_annotators"]
    assert (found["second"], found["matched"], found["only_first"], found["only_second"]) == (
        "ben.json",
        3,
        1,
        1,
    )
    # Squares 5 px apart overlap in 15 of 25 columns.
    assert found["iou"]["mean"] == pytest.approx((1 + 0.6 + 1) / 3)
    assert found["ignored"]["kappa"] == pytest.approx(0.0)
    assert found["ignored"]["agreed"] == pytest.approx(2 / 3)
    assert [each["file_name"] for each in found["images"]] == ["bed.png"]


def test_with_a_run_ignored_caps_are_left_out_and_nothing_is_claimed_of_them(
    folder: Path, tmp_path: Path, bens: Path
) -> None:
    elsewhere = bens.rename(tmp_path / "moved.json")
    out = tmp_path / "report.html"
    told = fairyring("review", folder, "--second", "ben.json", "--json", "--report", out)
    found = json.loads(told.stdout)["two_annotators"]
    assert (found["matched"], found["only_first"], found["only_second"]) == (2, 1, 1)
    assert found["px"]["mean"] == pytest.approx(2.5, abs=0.2)
    assert found["ignored"]["count"] == 0
    page = out.read_text()
    assert "<td>missed by ben.json</td><td>1</td>" in page
    assert "a run holds no caps to be ignored" in page
    assert elsewhere.is_file()


def test_photos_on_which_the_second_annotator_labelled_nothing_count_where_their_file_lists_them(
    folder: Path, tmp_path: Path
) -> None:
    cals = write(tmp_path / "cal.json", [square(7, 10.0)], photos=("bed.png", "other.png"))
    assert fairyring("import", folder, cals, "--as", "second").exit_code == 0
    cals.unlink()
    found = json.loads(fairyring("review", folder, "--second", "cal.json", "--json").stdout)["two_annotators"]
    # Of Ann's three that count Cal has the first; he left out her one on the other photo.
    assert (found["matched"], found["only_first"], found["only_second"]) == (1, 3, 0)
    assert [(each["file_name"], each["only_first"]) for each in found["images"]] == [
        ("bed.png", 2),
        ("other.png", 1),
    ]
    seen = json.loads(fairyring("runs", "show", folder, "cal.json", "--json").stdout)
    assert (seen["images"], seen["files"]) == (2, ["bed.png", "other.png"])


def test_a_review_against_a_second_annotator_is_of_the_photos_that_theirs_is_of(
    folder: Path, tmp_path: Path
) -> None:
    out = tmp_path / "report.html"
    found = json.loads(fairyring("review", folder, "--run", "ben.json", "--json", "--report", out).stdout)
    assert [(each["file_name"], each["missed"]) for each in found["images"]] == [("bed.png", 1)]
    page = out.read_text()
    for told in (
        "Held against ben.json, which a second annotator labelled.",
        "Contours of both annotators",
        "bed.png: ben.json",
        "Magenta: ben.json.",
        "Marked caps that ben.json has, too",
    ):
        assert told in page
    assert "predicted" not in page.replace("how far the predicted centre of a cap lies", "").replace(
        "predictions near it", ""
    )


def test_what_has_no_photo_in_common_is_refused(folder: Path, tmp_path: Path) -> None:
    strange = write(tmp_path / "strange.json", [square(1, 10.0)], photos=("elsewhere.png",))
    assert "no image in common" in sentence(fairyring("review", folder, "--second", strange))
    assert "There is no run called nobody" in sentence(fairyring("review", folder, "--second", "nobody"))


def test_labels_without_a_score_are_taken_for_predictions_and_the_other_way_is_told(
    folder: Path, tmp_path: Path
) -> None:
    cals = write(tmp_path / "cal.json", [square(7, 10.0), square(8, 55.0)])
    told = fairyring("import", folder, cals, "--as", "predictions")
    assert told.exit_code == 0
    assert "again with --as second" in told.stderr
    assert latest(folder) == ["cal.json"]
    again = fairyring("import", folder, cals, "--as", "second")
    assert "--as second" not in again.stderr
    assert "already there: 1 images, 2 shapes (2 the same, 0 changed; 0 gone)" in again.stdout
    assert latest(folder) == []


def latest(folder: Path) -> list[str]:
    """The runs that images show."""
    runs = json.loads(fairyring("runs", "list", folder, "--json").stdout)
    return [run["name"] for run in runs if run["latest_of"]]
