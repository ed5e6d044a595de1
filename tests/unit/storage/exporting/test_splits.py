"""The split of an image goes out with it, and each split as a data set of its own where that is asked for."""

import json

import pytest

from fairyring.storage.choices import ExportedPhotos, Only
from fairyring.storage.errors import StoreError
from fairyring.storage.exporting import Wanted
from fairyring.storage.exporting_splits import export_splits
from fairyring.storage.images import ImageFilter, get_image, list_ids
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import create_project
from fairyring.storage.records import Cap
from fairyring.storage.splits import set_splits
from tests.support.exported import SQUARE, export, store


@pytest.fixture
def split_beds(beds):
    """Image 1 to learn from, image 2 for validation, image 3 in no split; a cap on each."""
    for image in (1, 2, 3):
        store(beds, Cap(visible=[SQUARE]), image=image)
    beds.write(lambda connection: set_splits(connection, {1: "train", 2: "val"}))
    return beds


def test_an_image_says_its_split_and_one_in_none_says_nothing(split_beds, out):
    said = {image["file_name"]: image.get("split", "nothing") for image in export(split_beds, out)["images"]}
    assert said == {"bed_1.png": "train", "bed_2.png": "val", "bed_10.png": "nothing"}


def test_every_split_is_a_data_set_in_its_own_folder_and_none_is_learnt_from(split_beds, out):
    report = export_splits(split_beds, out, Wanted(only=Only.all))
    assert (report.images, report.annotations, report.splits) == (3, 3, {"train": 2, "val": 1})
    assert sorted(folder.name for folder in out.iterdir()) == ["train", "val"]
    for split, names in (("train", ["bed_1.png", "bed_10.png"]), ("val", ["bed_2.png"])):
        document = json.loads((out / split / "instances.json").read_text())
        assert [image["file_name"] for image in document["images"]] == names
        assert sorted(file.name for file in (out / split / "images").iterdir()) == sorted(names)
        assert len(document["annotations"]) == len(names)


def test_imported_again_the_folders_give_the_same_splits(split_beds, out, tmp_path):
    export_splits(split_beds, out, Wanted(only=Only.all))
    with create_project(tmp_path / "other") as other:
        assert import_paths(other, [out]).annotations == 3
        with other.read() as connection:
            images = [get_image(connection, each) for each in list_ids(connection, ImageFilter())]
    said = {image.file_name: image.split for image in images}
    assert said == {"bed_1.png": "train", "bed_2.png": "val", "bed_10.png": "train"}


def test_a_split_without_a_folder_ends_the_export_and_nothing_is_written(split_beds, out):
    split_beds.write(lambda connection: set_splits(connection, {3: "../../fold"}))
    with pytest.raises(StoreError, match=r"bed_10\.png is in the split \.\./\.\./fold"):
        export_splits(split_beds, out, Wanted(only=Only.all))
    assert not out.exists()


def test_a_split_whose_photos_are_all_gone_does_not_keep_the_others_from_going_out(split_beds, out):
    (split_beds.images / "bed_2.png").unlink()
    with pytest.raises(StoreError, match=r"bed_2\.png is gone"):
        export_splits(split_beds, out, Wanted(only=Only.all))
    report = export_splits(split_beds, out, Wanted(only=Only.all, skip_missing=True))
    assert (report.splits, len(report.left_out)) == ({"train": 2, "val": 0}, 1)


def test_labels_alone_can_be_divided_as_well(split_beds, out):
    export_splits(split_beds, out, Wanted(only=Only.all, photos=ExportedPhotos.none))
    assert [file.name for file in (out / "val").iterdir()] == ["instances.json"]
