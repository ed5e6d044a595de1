"""Two people's labels of one photo: what they agree on, and the third version that comes of both."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from fairyring.model.coco.document import read_document
from tests.support.terminal import fairyring, sentence


def square(number: int, x: float, **keys: Any) -> dict[str, Any]:
    """A cap of 20 × 20 px with its left edge at x and its centre marked in its middle."""
    outline = [x, 10.0, x + 20, 10.0, x + 20, 30.0, x, 30.0]
    own = {"id": number, "image_id": 1, "category_id": 1, "segmentation": [outline]}
    return own | {"circle": [x + 10, 20.0, 10.0]} | keys


def write(path: Path, caps: list[dict[str, Any]], *, image: int = 1) -> Path:
    photo = {"id": image, "file_name": "bed.png", "width": 200, "height": 100}
    entries = [cap | {"image_id": image} for cap in caps]
    categories = [{"id": 1, "name": "mushroom"}]
    path.write_text(json.dumps({"images": [photo], "annotations": entries, "categories": categories}))
    return path


@pytest.fixture
def versions(tmp_path: Path) -> tuple[Path, Path]:
    """Both have the first cap; the second has the next one 5 px further right; each has one of their own."""
    ann = [square(1, 10.0), square(2, 50.0), square(3, 100.0, ignored=True), square(4, 150.0)]
    ben = [square(7, 10.0), square(8, 55.0), square(9, 100.0), square(10, 175.0)]
    return write(tmp_path / "ann.json", ann), write(tmp_path / "ben.json", ben, image=5)


def test_matched_missed_and_extra_caps_and_how_far_they_are_apart(versions: tuple[Path, Path]) -> None:
    found = json.loads(fairyring("agreement", *versions, "--json").stdout)
    assert (found["matched"], found["only_first"], found["only_second"]) == (3, 1, 1)
    # Squares 5 px apart overlap in 15 of 25 columns.
    assert found["iou"]["mean"] == pytest.approx((1 + 0.6 + 1) / 3)
    assert found["px"]["mean"] == pytest.approx(5 / 3)
    assert found["cdr"]["mean"] == pytest.approx(100 * 5 / 200 / 3)
    assert found["ignored"]["kappa"] == pytest.approx(0.0)
    assert found["ignored"]["agreed"] == pytest.approx(2 / 3)
    assert found["images"][0]["file_name"] == "bed.png"
    assert "only first" in fairyring("agreement", *versions).stdout


def test_the_third_version_holds_what_both_agree_on_and_doubts_the_rest(
    versions: tuple[Path, Path], tmp_path: Path
) -> None:
    before = [path.read_bytes() for path in versions]
    out = tmp_path / "third.json"
    assert fairyring("agreement", *versions, "--adjudicated", out).exit_code == 0
    third = {cap["id"]: cap for cap in json.loads(out.read_text())["annotations"]}
    assert {number: cap.get("doubt", False) for number, cap in third.items()} == {
        1: False,
        2: True,  # 5 px apart
        3: True,  # one of them ignores it
        4: True,  # only the first has it
        5: True,  # only the second has it
    }
    assert third[5]["segmentation"][0][0] == 175.0
    assert {cap["image_id"] for cap in third.values()} == {1}
    assert [path.read_bytes() for path in versions] == before
    assert read_document(out).others["categories"] == [{"id": 1, "name": "mushroom"}]


def test_caps_without_an_id_of_their_own_are_refused(tmp_path: Path) -> None:
    twice = write(tmp_path / "twice.json", [square(1, 10.0), square(1, 50.0)])
    assert "id" in sentence(fairyring("agreement", twice, twice))


def test_the_third_version_never_takes_the_place_of_the_two(
    versions: tuple[Path, Path], tmp_path: Path
) -> None:
    before = [path.read_bytes() for path in versions]
    link = tmp_path / "link.json"
    link.symlink_to(versions[1])
    for out in (versions[0], link):
        told = fairyring("agreement", *versions, "--adjudicated", out)
        assert told.exit_code == 2
        assert "name another file" in told.stderr
    assert [path.read_bytes() for path in versions] == before


def test_a_file_that_is_not_there_is_named_alone(versions: tuple[Path, Path], tmp_path: Path) -> None:
    told = sentence(fairyring("agreement", versions[0], tmp_path / "nobody.json"))
    assert "nobody.json cannot be read" in told
    assert versions[0].name not in told
