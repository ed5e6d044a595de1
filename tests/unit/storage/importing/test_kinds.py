"""What a path is taken for: photos, COCO or labelme, as found or as said."""

import json
import shutil

import pytest

from fairyring.model.geometry.shapes import Circle, Polygon
from fairyring.storage.errors import StoreError
from fairyring.storage.importing.paths import import_paths
from tests.support.imported import annotations_of


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
    outlined, marked = annotations_of(project, image=2)
    assert outlined.cap.mark == Polygon(outlined.cap.visible[0])
    assert (marked.cap.visible, marked.cap.mark, marked.whole) == ([], Circle(50, 50, 8), Circle(50, 50, 8))
    assert import_paths(project, [folder]).known == 4


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
