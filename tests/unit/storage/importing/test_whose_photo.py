"""Whose photo a COCO file speaks of: by base name and size, in the project or beside the file."""

import pytest

from fairyring.storage.errors import StoreError
from fairyring.storage.images import find_image
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.records import Cap
from tests.support.imported import annotations_of, reasons
from tests.unit.storage.conftest import TRIANGLE


def test_coco_annotations_find_their_image_by_base_name_and_size(beds, write_coco, square):
    images = [{"id": 7, "file_name": "C:\\somewhere\\bed_2.png", "width": 100, "height": 80}]
    file = write_coco([{"image_id": 7, "segmentation": square, "source": "hand"}], images=images)
    report = import_paths(beds, [file])
    assert (report.images, report.images_known, report.annotations, report.problems) == (0, 1, 1, [])
    (annotation,) = annotations_of(beds, image=2)
    assert (annotation.cap, annotation.revision) == (Cap(visible=square), 1)
    assert annotation.extra == {"source": "hand"}
    assert (annotation.whole, annotation.centre) == (None, None)


@pytest.mark.parametrize("place", ["bed_9.png", "images/bed_9.png"])
def test_a_photo_beside_the_file_is_taken_along(project, tmp_path, write_coco, write_photo, place):
    write_photo(tmp_path / "labels" / place)
    images = [
        {"id": 1, "file_name": "deep/down/bed_9.png", "width": 100, "height": 80, "light": "dark", "x": 1}
    ]
    report = import_paths(
        project, [write_coco([{"segmentation": TRIANGLE}], images=images)], light="top", form="b"
    )
    assert (report.images, report.annotations) == (1, 1)
    with project.read() as connection:
        image = find_image(connection, "bed_9.png")
    assert (image.light, image.form, image.extra) == ("dark", "b", {"x": 1})


def test_what_a_file_says_of_a_known_photo_fills_gaps_and_changes_nothing(beds, write_coco):
    def say(light, split):
        image = {"id": 1, "file_name": "bed_1.png", "light": light, "split": split, "camera": split}
        import_paths(beds, [write_coco([], images=[image])])
        with beds.read() as connection:
            return find_image(connection, "bed_1.png")

    first = say("dark", "train")
    assert (first.light, first.split, first.extra) == ("dark", "train", {"camera": "train"})
    assert say("top", "test") == first


@pytest.mark.parametrize("name", ["missing.png", "../secret.png", "/etc/secret.png"])
def test_an_image_that_is_nowhere_is_reported(beds, tmp_path, write_coco, write_photo, name):
    write_photo(tmp_path / "secret.png")
    images = [{"id": 1, "file_name": "bed_1.png"}, {"id": 2, "file_name": name}]
    report = import_paths(beds, [write_coco([{"segmentation": TRIANGLE}], images=images)])
    assert report.annotations == 1
    assert "is neither in the project nor beside this file" in reasons(report)[0]


def test_a_symbolic_link_beside_the_file_is_refused(project, tmp_path, write_coco, write_photo, square):
    secret = write_photo(tmp_path / "secret.png")
    file = write_coco([{"segmentation": square}])
    (file.parent / "bed_1.png").symlink_to(secret)
    with pytest.raises(StoreError, match="is a symbolic link"):
        import_paths(project, [file])


def test_a_size_that_differs_is_reported_in_figures(beds, write_coco, square):
    images = [{"id": 1, "file_name": "bed_1.png", "width": 80, "height": 100}]
    with pytest.raises(StoreError, match="100 × 80 pixels when upright, but this file says 80 × 100"):
        import_paths(beds, [write_coco([{"segmentation": square}], images=images)])
