"""Whose photo a COCO file speaks of: by base name and size, in the project or beside the file."""

import json
from unicodedata import normalize

import pytest

from fairyring.storage.errors import StoreError
from fairyring.storage.images import find_image
from fairyring.storage.importing.intake import Facts
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
        project,
        [write_coco([{"segmentation": TRIANGLE}], images=images)],
        unsaid=Facts(light="top", form="b"),
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


SPELLINGS = [
    (normalize("NFD", "Beet é ü.png"), normalize("NFC", "Beet é ü.png")),
    (normalize("NFC", "Beet é ü.png"), normalize("NFD", "Beet é ü.png")),
    ("IMG_1.JPG", "img_1.jpg"),
    ("Straße.png", "STRASSE.PNG"),
    ("Beet 1 é.png", "Beet%201%20%C3%A9.png"),
    ("bed_1.png", "/data/upload/3/9f1c2d3e-bed_1.png"),
    ("bed 1.png", "/data/upload/3/9f1c2d3e-bed%201.png"),
    ("100%25.png", "100%25.png"),
]


@pytest.fixture(params=SPELLINGS, ids=[other for _, other in SPELLINGS])
def spelt_otherwise(request, tmp_path, write_coco, write_photo, square):
    """A photo, and a file that labels it by another spelling of its name."""
    on_disk, in_the_file = request.param
    photo = write_photo(tmp_path / "labels" / on_disk)
    return photo, write_coco([{"segmentation": square}], images=[{"id": 1, "file_name": in_the_file}])


def test_a_photo_beside_the_file_is_known_however_tools_write_its_name(project, spelt_otherwise):
    photo, file = spelt_otherwise
    report = import_paths(project, [file], strict=True)
    assert (report.annotations, report.images) == (1, 1)
    with project.read() as connection:
        assert find_image(connection, normalize("NFC", photo.name)) is not None


def test_a_photo_of_the_project_is_known_however_tools_write_its_name(project, spelt_otherwise):
    photo, file = spelt_otherwise
    import_paths(project, [photo])
    photo.unlink()
    report = import_paths(project, [file], strict=True)
    assert (report.annotations, report.images_known) == (1, 1)


def test_two_photos_that_differ_in_case_are_not_taken_for_each_other(
    project, tmp_path, write_coco, write_photo, square
):
    for name in ("bed.png", "BED.png"):
        write_photo(tmp_path / "labels" / name)
    images = [{"id": 1, "file_name": "BED.png"}, {"id": 2, "file_name": "Bed.png"}]
    file = write_coco([{"segmentation": square}, {"image_id": 2, "segmentation": square}], images=images)

    report = import_paths(project, [file])

    assert report.annotations == 1
    with project.read() as connection:
        assert find_image(connection, "BED.png") is not None
    (reason,) = reasons(report)
    assert reason.startswith("Bed.png is neither in the project nor beside this file")
    assert "if bed.png is meant" in reason or "if BED.png is meant" in reason


@pytest.mark.parametrize(
    "name", ["bed_1_png.rf.0123456789abcdef.jpg", "copy of bed_1.png", "bed_1.jpg", "bde_1.png"]
)
def test_a_name_that_is_nearly_one_is_asked_about(beds, write_coco, square, name):
    file = write_coco([{"segmentation": square}], images=[{"id": 1, "file_name": name}])
    with pytest.raises(StoreError, match=r"if bed_1\.png is meant, call it that in this file"):
        import_paths(beds, [file])


def test_a_linked_folder_beside_the_file_is_not_followed(project, tmp_path, write_coco, write_photo, square):
    write_photo(tmp_path / "private" / "bed_1.png")
    file = write_coco([{"segmentation": square}])
    (file.parent / "images").symlink_to(tmp_path / "private")
    with pytest.raises(StoreError, match="images is a symbolic link; import what it points to"):
        import_paths(project, [file])


@pytest.mark.parametrize(("data", "said"), [("aGVsb", "is damaged"), ("aGVsbG8=", "is no photo")])
def test_a_photo_within_labels_that_is_none_is_told_without_a_path_of_the_import(beds, tmp_path, data, said):
    points = [[1, 1], [30, 1], [30, 30]]
    shape = {"label": "mushroom", "points": points, "shape_type": "polygon"}
    file = tmp_path / "bed_9.json"
    file.write_text(json.dumps({"shapes": [shape], "imagePath": "bed_9.png", "imageData": data}))
    report = import_paths(beds, [file, beds.images / "bed_1.png"])
    assert reasons(report) == [f"bed_9.png is not beside this file, and the imageData in it {said}."]


def test_the_one_file_that_nothing_came_of_is_named_once(project, tmp_path):
    empty = tmp_path / "empty.png"
    empty.touch()
    with pytest.raises(StoreError) as told:
        import_paths(project, [empty])
    assert str(told.value).count(str(empty)) == 1
