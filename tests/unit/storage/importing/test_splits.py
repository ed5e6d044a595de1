"""Splits are read from folders and from files of labels, and copies of one photo are never in two."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from fairyring.storage.choices import KnownCaps
from fairyring.storage.images import ImageFilter, get_image, list_ids
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import Project
from fairyring.storage.splits import set_splits
from tests.strangers.bed import photo, write
from tests.strangers.coco import caps, document, image


def splits(project: Project) -> dict[str, str | None]:
    with project.read() as connection:
        images = [get_image(connection, number) for number in list_ids(connection, ImageFilter())]
    return {image.file_name: image.split for image in images}


@pytest.mark.parametrize(
    ("folders", "said"),
    [
        (("train", "val", "test"), ("train", "val", "test")),
        (("Train", "valid", "testing"), ("train", "val", "test")),
        (("train2017", "val2017", "test2017"), ("train", "val", "test")),
        (("training/images", "validation/images", "others"), ("train", "val", None)),
        (("images/train", "images/val", "testbeds"), ("train", "val", None)),
    ],
)
def test_photos_are_in_the_split_of_the_folder_they_lie_in(
    project: Project, tmp_path: Path, folders: tuple[str, ...], said: tuple[str | None, ...]
) -> None:
    for nth, folder in enumerate(folders):
        photo(tmp_path / "set" / folder / f"{nth}.jpg", moved=nth)
    import_paths(project, [tmp_path / "set"])
    assert tuple(splits(project).values()) == said


def test_labels_in_the_folder_of_a_split_bring_photos_of_that_split(project: Project, tmp_path: Path) -> None:
    for nth, folder in enumerate(("train", "valid")):
        photo(tmp_path / folder / f"{nth}.jpg", moved=nth)
        labels = document([image(1, f"{nth}.jpg")], caps())
        write(tmp_path / folder / "_annotations.coco.json", labels)
    import_paths(project, [tmp_path / "train" / "_annotations.coco.json", tmp_path / "valid"])
    assert splits(project) == {"0.jpg": "train", "1.jpg": "val"}


def test_a_folder_test_that_stands_alone_may_hold_anything(project: Project, tmp_path: Path) -> None:
    photo(tmp_path / "test" / "a.jpg")
    import_paths(project, [tmp_path / "test"])
    photo(tmp_path / "test" / "b" / "b.jpg", moved=1)
    import_paths(project, [tmp_path / "test" / "b" / "b.jpg"])
    assert splits(project) == {"a.jpg": None, "b.jpg": None}


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("valid/a.jpg", "val"),
        ("images\\test\\a.jpg", "test"),
        ("/elsewhere/test/a.jpg", None),
        ("a.jpg", None),
    ],
)
def test_the_folder_that_labels_write_before_a_name_says_it_of_a_known_photo(
    project: Project, tmp_path: Path, written: str, said: str | None
) -> None:
    photo(tmp_path / "photos" / "a.jpg")
    import_paths(project, [tmp_path / "photos"])
    write(tmp_path / "labels.json", document([image(1, written)], caps()))
    import_paths(project, [tmp_path / "labels.json"])
    assert splits(project) == {"a.jpg": said}


@pytest.mark.parametrize(("key", "said"), [("valid", "val"), ("Testing", "test"), ("fold 3", "fold 3")])
def test_the_key_of_an_image_goes_before_its_folder(
    project: Project, tmp_path: Path, key: str, said: str
) -> None:
    photo(tmp_path / "set" / "train" / "a.jpg")
    write(tmp_path / "set" / "train" / "labels.json", document([image(1, "a.jpg", split=key)], caps()))
    import_paths(project, [tmp_path / "set" / "train" / "labels.json"])
    assert splits(project) == {"a.jpg": said}


def test_an_import_leaves_the_split_that_an_image_of_the_project_has(
    project: Project, tmp_path: Path
) -> None:
    photo(tmp_path / "set" / "train" / "a.jpg")
    import_paths(project, [tmp_path / "set"])
    write(tmp_path / "labels.json", document([image(1, "a.jpg", split="test")], caps()))
    assert import_paths(project, [tmp_path / "labels.json"]).problems == []
    assert splits(project) == {"a.jpg": "train"}


def test_copies_that_lie_in_two_splits_are_held_out_and_named(project: Project, tmp_path: Path) -> None:
    photo(tmp_path / "set" / "train" / "a.jpg")
    (tmp_path / "set" / "valid").mkdir()
    shutil.copy(tmp_path / "set" / "train" / "a.jpg", tmp_path / "set" / "valid" / "b.jpg")
    photo(tmp_path / "set" / "test" / "c.jpg", moved=1)
    (problem,) = import_paths(project, [tmp_path / "set"]).problems
    assert str(problem) == (
        "a.jpg and b.jpg: Copies of one photo, said to be of the splits train and val: it is val now."
    )
    assert splits(project) == {"a.jpg": "val", "b.jpg": "val", "c.jpg": "test"}


def test_one_photo_in_two_folders_is_held_out_too(project: Project, tmp_path: Path) -> None:
    photo(tmp_path / "set" / "test" / "a.jpg")
    (tmp_path / "set" / "train").mkdir()
    shutil.copy(tmp_path / "set" / "test" / "a.jpg", tmp_path / "set" / "train" / "a.jpg")
    (problem,) = import_paths(project, [tmp_path / "set"]).problems
    assert "One photo, said to be of the splits test and train" in problem.reason
    assert splits(project) == {"a.jpg": "test"}


def test_a_copy_of_a_photo_of_the_project_follows_it_and_it_follows_a_copy(
    project: Project, tmp_path: Path
) -> None:
    photo(tmp_path / "a.jpg")
    photo(tmp_path / "b.jpg", moved=1)
    import_paths(project, [tmp_path / "a.jpg", tmp_path / "b.jpg"])
    project.write(lambda connection: set_splits(connection, {1: "train"}))
    for nth, name in enumerate(("a", "b")):
        (tmp_path / "set" / "val").mkdir(parents=True, exist_ok=True)
        shutil.copy(tmp_path / f"{name}.jpg", tmp_path / "set" / "val" / f"copy_{nth}.jpg")
    (problem,) = import_paths(project, [tmp_path / "set"]).problems
    assert "it is train now" in problem.reason
    assert splits(project) == {"a.jpg": "train", "b.jpg": "val", "copy_0.jpg": "train", "copy_1.jpg": "val"}


def test_another_split_of_a_file_is_told_and_comes_in_with_an_update(
    project: Project, tmp_path: Path
) -> None:
    photo(tmp_path / "a.jpg")
    labels = write(
        tmp_path / "labels.json", document([image(1, "a.jpg", split="train", light="top")], caps())
    )
    assert import_paths(project, [labels]).images_otherwise == 0
    write(labels, document([image(1, "a.jpg", split="test", light="side")], caps()))
    assert import_paths(project, [labels]).images_otherwise == 1
    assert splits(project) == {"a.jpg": "train"}
    assert import_paths(project, [labels], known_caps=KnownCaps.update).images_otherwise == 1
    with project.read() as connection:
        updated = get_image(connection, 1)
    assert (updated.split, updated.light) == ("test", "side")
    assert import_paths(project, [labels]).images_otherwise == 0
