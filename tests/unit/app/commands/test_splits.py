"""The command split: by name, by list, at random; copies of a photo go along, and training obeys."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from fairyring.storage.images import ImageFilter, get_image, list_ids
from fairyring.storage.project import create_project, open_project
from tests.strangers.bed import photo
from tests.support.terminal import fairyring, sentence


@pytest.fixture
def beds(tmp_path: Path) -> Path:
    """A project of ten photos and of a copy of the first by another name."""
    for nth in range(10):
        photo(tmp_path / "photos" / f"bed_{nth}.jpg", moved=nth)
    shutil.copy(tmp_path / "photos" / "bed_0.jpg", tmp_path / "photos" / "copy.jpg")
    create_project(tmp_path / "beds").close()
    fairyring("import", tmp_path / "beds", tmp_path / "photos")
    return tmp_path / "beds"


def splits(folder: Path) -> dict[str, str | None]:
    with open_project(folder) as project, project.read() as connection:
        images = [get_image(connection, number) for number in list_ids(connection, ImageFilter())]
    return {image.file_name: image.split for image in images}


def test_images_are_put_into_a_split_by_pattern_and_by_list(beds: Path, tmp_path: Path) -> None:
    listed = tmp_path / "names.txt"
    listed.write_text("bed_8.jpg\n\n  bed_9.jpg \n")
    done = fairyring("split", beds, "bed_1*", "--list", listed, "--to", "test")
    assert done.stdout == "test 3, none 8\n"
    assert {name for name, split in splits(beds).items() if split == "test"} == {
        "bed_1.jpg",
        "bed_8.jpg",
        "bed_9.jpg",
    }
    fairyring("split", beds, "bed_8.jpg", "--to", "none")
    assert json.loads(fairyring("split", beds, "--json").stdout)["splits"] == {"test": 2, "none": 9}
    fairyring("split", beds, "*", "--unsplit", "--to", "train")
    assert fairyring("split", beds).stdout == "test 2, train 9\n"


def test_a_copy_of_a_photo_goes_along_whichever_of_the_two_is_named(beds: Path) -> None:
    told = fairyring("split", beds, "copy.jpg", "--to", "val").stderr
    assert "2 images, 1 of them copies of photos that were named" in told
    assert splits(beds)["bed_0.jpg"] == splits(beds)["copy.jpg"] == "val"


@pytest.mark.parametrize("seed", range(5))
def test_images_are_divided_at_random_by_photos_and_the_seed_decides(beds: Path, seed: int) -> None:
    divide = ("split", beds, "--random", 60, 20, 20, "--seed", seed)
    fairyring(*divide)
    once = splits(beds)
    assert once["bed_0.jpg"] == once["copy.jpg"]
    own = [split for name, split in once.items() if name != "copy.jpg"]
    assert (own.count("train"), own.count("val"), own.count("test")) == (6, 2, 2)
    fairyring("split", beds, "*", "--to", "none")
    fairyring(*divide)
    assert splits(beds) == once
    fairyring("split", beds, "--random", 60, 20, 20, "--seed", seed + 100)
    assert splits(beds) != once


def test_later_photos_are_divided_without_moving_those_that_have_a_split(beds: Path) -> None:
    fairyring("split", beds, "bed_0.jpg", "bed_1.jpg", "--to", "test")
    fairyring("split", beds, "--random", 0.5, 0.5, 0, "--unsplit")
    now = splits(beds)
    assert now["copy.jpg"] == "test"
    assert [*now.values()].count("test") == 3
    assert [*now.values()].count("train") == [*now.values()].count("val") == 4


@pytest.mark.parametrize(
    "options",
    [
        ("bed_1.jpg",),
        ("--to", "test"),
        ("*", "--to", "test", "--random", 1, 1, 1),
        ("--random", 0, 0, 0),
        ("--random", 2, -1, 0),
        ("--to", "holdout"),
    ],
)
def test_what_says_too_little_or_too_much_is_wrong_use_and_changes_nothing(
    beds: Path, options: tuple[object, ...]
) -> None:
    assert fairyring("split", beds, *options).exit_code == 2
    assert not any(splits(beds).values())


def test_a_name_that_no_image_has_is_refused(beds: Path) -> None:
    done = fairyring("split", beds, "bed_1.jpg", "nothing", "--to", "test")
    assert (done.exit_code, "is called nothing" in sentence(done)) == (1, True)
    assert not any(splits(beds).values())


def test_an_export_by_split_says_how_many_went_where(beds: Path, tmp_path: Path) -> None:
    fairyring("split", beds, "bed_1.jpg", "--to", "val")
    export = ("export", beds, tmp_path / "out", "--only", "all", "--by-split")
    assert "10 in train/; 1 in val/" in fairyring(*export).stdout
    assert (tmp_path / "out" / "val" / "instances.json").exists()
    assert fairyring(*export, "--results", tmp_path / "r.json").exit_code == 2
