"""Photos of one base name in several folders: two images, each with its own labels."""

from unicodedata import normalize

import cv2
import numpy as np
import pytest

from fairyring.storage.backup import back_up, restore
from fairyring.storage.errors import StoreError
from fairyring.storage.images import ImageFilter, find_image, list_images
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import open_project
from tests.support.imported import annotations_of, files_of, reasons
from tests.unit.storage.conftest import TRIANGLE


def names_of(project):
    with project.read() as connection:
        return [row.image.file_name for row in list_images(connection, ImageFilter(sort="added")).rows]


@pytest.fixture
def of_two_days(tmp_path, write_photo):
    """A folder with monday/bed.png and tuesday/bed.png."""
    for seed, day in enumerate(("monday", "tuesday")):
        write_photo(tmp_path / "days" / day / "bed.png", seed=seed)
    write_photo(tmp_path / "days" / "tuesday" / "other.png")
    return tmp_path / "days"


def test_photos_of_one_name_in_two_folders_are_two_images(project, of_two_days):
    report = import_paths(project, [of_two_days])
    assert (report.images, report.problems) == (3, [])
    assert names_of(project) == ["monday/bed.png", "tuesday/bed.png", "other.png"]
    assert files_of(project) == ["monday", "monday/bed.png", "other.png", "tuesday", "tuesday/bed.png"]
    again = import_paths(project, [of_two_days])
    assert (again.images, again.images_known) == (0, 3)


def test_the_second_of_a_name_in_a_later_import_gets_its_folder_too(beds, tmp_path, write_photo):
    other = write_photo(tmp_path / "later" / "bed_1.png", seed=5)
    import_paths(beds, [other])
    assert names_of(beds) == ["bed_1.png", "bed_2.png", "bed_10.png", "later/bed_1.png"]
    deeper = write_photo(tmp_path / "x" / "later" / "bed_1.png", seed=6)
    import_paths(beds, [deeper])
    assert names_of(beds)[-1] == "x/later/bed_1.png"


def test_labels_find_the_photo_of_their_folder(project, of_two_days, write_coco, square):
    import_paths(project, [of_two_days])
    images = [{"id": 1, "file_name": "days/monday/bed.png"}, {"id": 2, "file_name": "days/tuesday/bed.png"}]
    annotations = [{"segmentation": square}, {"image_id": 2, "segmentation": TRIANGLE}]
    report = import_paths(project, [write_coco(annotations, images=images)], strict=True)
    assert report.annotations == 2
    assert [cap.cap.visible for cap in annotations_of(project, image=1)] == [square]
    assert [cap.cap.visible for cap in annotations_of(project, image=2)] == [TRIANGLE]


def test_labels_beside_their_photo_are_of_that_one(beds, tmp_path, write_photo, write_coco, square):
    write_photo(tmp_path / "labels" / "bed_1.png", seed=5)
    report = import_paths(beds, [write_coco([{"segmentation": square}])], strict=True)
    assert (report.images, report.annotations) == (1, 1)
    assert annotations_of(beds, image=1) == []
    with beds.read() as connection:
        assert find_image(connection, "labels/bed_1.png") is not None


def test_labels_that_may_be_of_two_photos_are_asked_about(project, of_two_days, write_coco, square):
    import_paths(project, [of_two_days])
    file = write_coco([{"segmentation": square}], images=[{"id": 1, "file_name": "bed.png"}])
    with pytest.raises(StoreError, match=r"monday/bed\.png, tuesday/bed\.png; write the folder before"):
        import_paths(project, [file])


def test_a_photo_that_a_tool_saved_anew_is_the_same(project, tmp_path, write_coco, square):
    rows, columns = np.mgrid[:80, :100]
    picture = np.stack([rows, columns, rows + columns], axis=2).astype(np.uint8)
    own = tmp_path / "bed_1.jpg"
    cv2.imwrite(str(own), picture, [cv2.IMWRITE_JPEG_QUALITY, 98])
    import_paths(project, [own])
    (tmp_path / "labels").mkdir()
    cv2.imwrite(str(tmp_path / "labels" / "bed_1.jpg"), cv2.imread(str(own)), [cv2.IMWRITE_JPEG_QUALITY, 80])
    file = write_coco([{"segmentation": square}], images=[{"id": 1, "file_name": "bed_1.jpg"}])
    report = import_paths(project, [file, file.parent], strict=True)
    assert (report.images, report.images_known, report.annotations) == (0, 1, 1)


def test_images_in_folders_survive_a_backup(project, of_two_days, tmp_path):
    import_paths(project, [of_two_days])
    back_up(project, tmp_path / "backup")
    restore(tmp_path / "backup", tmp_path / "again")
    with open_project(tmp_path / "again") as again:
        assert names_of(again) == names_of(project)
        assert files_of(again) == files_of(project)


def test_a_failed_import_leaves_no_folder_behind(project, of_two_days, write_photo):
    write_photo(project.images / "other.png", seed=9)
    with pytest.raises(StoreError, match="is in the way of"):
        import_paths(project, [of_two_days])
    assert files_of(project) == ["other.png"]


@pytest.mark.parametrize("name", ["../secret.png", "/etc/secret.png", "../../x/secret.png"])
def test_a_file_of_labels_leads_nowhere_that_was_not_named(project, tmp_path, write_photo, write_coco, name):
    for place in ("secret.png", "x/secret.png"):
        write_photo(tmp_path / "a" / place)
    file = write_coco([], images=[{"id": 1, "file_name": name}], path=tmp_path / "a" / "labels" / "l.json")
    with pytest.raises(StoreError, match="is neither in the project nor beside this file"):
        import_paths(project, [file])


def test_it_leads_anywhere_in_a_folder_that_was_named(project, tmp_path, write_photo, write_coco, square):
    write_photo(tmp_path / "set" / "deep" / "bed.png")
    file = write_coco(
        [{"segmentation": square}],
        images=[{"id": 1, "file_name": "../../deep/bed.png"}],
        path=tmp_path / "set" / "a" / "b" / "labels.json",
    )
    report = import_paths(project, [file.parents[2]])
    assert (report.images, report.annotations, reasons(report)) == (1, 1, [])


def test_two_photos_of_one_name_in_other_letters_are_told_and_the_rest_goes_in(
    project, tmp_path, write_photo
):
    composed, decomposed = (normalize(form, "b\u00e9d.png") for form in ("NFC", "NFD"))
    write_photo(tmp_path / "in" / composed, seed=1)
    write_photo(tmp_path / "in" / decomposed, seed=2)
    if len(list((tmp_path / "in").iterdir())) == 1:
        pytest.skip("This file system knows one name only.")
    write_photo(tmp_path / "in" / "other.png", seed=3)
    report = import_paths(project, [tmp_path / "in"])
    assert (report.images, reasons(report)) == (
        2,
        ["Beside it lies another photo of the same name, written in other letters; rename one of them."],
    )


def test_a_photo_like_one_that_was_put_in_the_place_of_another_is_another_image(
    project, tmp_path, write_photo, write_coco
):
    import_paths(project, [write_photo(tmp_path / "first" / "bed.png", seed=1)])
    labels = write_coco([{"segmentation": TRIANGLE}], images=[{"id": 1, "file_name": "bed.png"}])
    other = write_photo(labels.parent / "bed.png", seed=2)
    (project.images / "bed.png").write_bytes(other.read_bytes())
    report = import_paths(project, [labels])
    assert (report.images, report.annotations) == (1, 1)
    assert names_of(project) == ["bed.png", "labels/bed.png"]
    assert annotations_of(project, image=1) == []
