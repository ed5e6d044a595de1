"""What a path is taken for: photos, COCO or labelme, as found or as said."""

import gzip
import json
import shutil
from pathlib import Path

import pytest

from fairyring.model.geometry.shapes import Circle, Polygon
from fairyring.storage.choices import Polygons
from fairyring.storage.errors import StoreError
from fairyring.storage.importing.paths import import_paths
from tests.support.imported import annotations_of, reasons


def test_a_folder_of_labelme_files_and_photos(project, tmp_path, write_photo):
    folder = tmp_path / "labelled"
    for name in ("a", "b"):
        write_photo(folder / f"{name}.png")
        shapes = [
            {"label": "mushroom", "points": [[10, 10], [30, 10], [20, 30]], "shape_type": "polygon"},
            {"label": "mushroom", "points": [[50, 50], [50, 58]], "shape_type": "circle"},
        ]
        document = {"shapes": shapes, "imagePath": f"..\\x\\{name}.png", "imageHeight": 80, "imageWidth": 100}
        (folder / f"{name}.json").write_text(json.dumps(document))
    report = import_paths(project, [folder])
    assert (report.images, report.annotations, report.problems) == (2, 4, [])
    assert report.polygons == 2
    outlined, marked = annotations_of(project, image=2)
    assert outlined.cap.mark is None
    assert (marked.cap.visible, marked.cap.mark, marked.whole) == ([], Circle(50, 50, 8), Circle(50, 50, 8))
    assert import_paths(project, [folder]).known == 4


def test_the_same_outline_from_coco_and_from_labelme_is_one_cap(beds, tmp_path, write_coco, square):
    shape = {"label": "mushroom", "points": [[10, 10], [30, 10], [30, 30], [10, 30]]}
    labelme = tmp_path / "bed_1.json"
    labelme.write_text(json.dumps({"shapes": [shape], "imagePath": "bed_1.png"}))
    coco = write_coco([{"segmentation": square}])
    assert import_paths(beds, [coco]).annotations == 1
    again = import_paths(beds, [labelme])
    assert (again.annotations, again.known) == (0, 1)


def test_labelme_polygons_are_marks_where_that_is_said(beds, tmp_path):
    shape = {"label": "mushroom", "points": [[10, 10], [30, 10], [30, 30], [10, 30]]}
    file = tmp_path / "bed_1.json"
    file.write_text(json.dumps({"shapes": [shape], "imagePath": "bed_1.png"}))
    import_paths(beds, [file], polygons=Polygons.marks)
    (annotation,) = annotations_of(beds)
    assert annotation.cap.mark == Polygon(annotation.cap.visible[0])


def test_the_format_can_be_said(beds, write_coco, square, tmp_path):
    file = write_coco([{"segmentation": square}])
    with pytest.raises(StoreError, match="is not a labelme file"):
        import_paths(beds, [file], kind="labelme")
    named = shutil.copy(file, tmp_path / "labels.txt")
    assert import_paths(beds, [tmp_path / "labels.txt"], kind="coco").annotations == 1
    assert named.exists()


def test_an_import_of_images_leaves_labels_alone(project, write_coco, write_photo, square):
    file = write_coco([{"segmentation": square}])
    write_photo(file.parent / "bed_1.png")
    report = import_paths(project, [file.parent], kind="images")
    assert (report.images, report.annotations) == (1, 0)


def test_all_that_is_passed_over_in_a_folder_is_named(project, tmp_path, write_photo):
    folder = tmp_path / "in"
    outside = write_photo(tmp_path / "outside.png")
    for name in ("good.png", "other.jpg", ".hidden.png", ".cache/deep.png", "deep/.also.png"):
        write_photo(folder / name)
    (folder / "other.jpg").rename(folder / "other.JFIF")
    for name in ("bed.heic", "notes.txt", "video", ".DS_Store", "Thumbs.db"):
        (folder / name).write_text("")
    (folder / "linked.png").symlink_to(outside)
    (folder / "linked").symlink_to(tmp_path)
    (folder / "broken.png").symlink_to(tmp_path / "nowhere")

    report = import_paths(project, [folder])

    assert report.images == 2
    passed_over = {str(Path(p.file).relative_to(folder)): p.reason for p in report.problems}
    assert {name: reason.split(";")[0] for name, reason in passed_over.items()} == {
        ".cache": "It was passed over: it is hidden",
        ".hidden.png": "It was passed over: it is hidden",
        "deep/.also.png": "It was passed over: it is hidden",
        "linked": "It was passed over: it is a symbolic link",
        "linked.png": "It was passed over: it is a symbolic link",
        "broken.png": "It was passed over: it is a symbolic link",
        "bed.heic": "It was passed over: it is a photo in HEIC, which is not read",
        "notes.txt": "It was passed over: by its name it is neither a photo nor a file of labels.",
        "video": "It was passed over: by its name it is neither a photo nor a file of labels.",
    }
    with pytest.raises(StoreError, match=r"Nothing was imported, as asked: .*\(8 more\)"):
        import_paths(project, [folder], strict=True)


@pytest.mark.parametrize("by_folder", [True, False])
def test_a_gzipped_file_of_labels_is_one_and_another_archive_is_refused(
    beds, write_coco, square, tmp_path, by_folder
):
    folder = tmp_path / "zipped"
    folder.mkdir()
    zipped = folder / "labels.json.gz"
    zipped.write_bytes(gzip.compress(write_coco([{"segmentation": square}]).read_bytes()))
    assert import_paths(beds, [folder if by_folder else zipped]).annotations == 1
    (tmp_path / "photos.tar.gz").write_bytes(b"")
    with pytest.raises(StoreError, match="is an archive"):
        import_paths(beds, [tmp_path / "photos.tar.gz"])


def test_a_file_of_labels_that_holds_them_wrongly_is_no_stray_file(beds, tmp_path):
    folder = tmp_path / "in"
    folder.mkdir()
    (folder / "settings.json").write_text('{"theme": "dark"}')
    labels = folder / "labels.json"
    labels.write_text('{"images": [], "annotations": {"1": {}}}')
    with pytest.raises(StoreError, match="Nothing was imported"):
        import_paths(beds, [folder])
    report = import_paths(beds, [folder, beds.images / "bed_1.png"])
    assert report.useless == [str(labels)]
    assert reasons(report) == [
        "This is not a COCO file: its annotations are not a list.",
        "It was passed over: there are no labels in it that could be read.",
    ]
