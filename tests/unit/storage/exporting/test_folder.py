"""The folder an export fills: the document, the photos upright, and nothing if it fails."""

import json
from concurrent.futures import CancelledError

import cv2
import numpy as np
import pytest
from PIL import Image

from fairyring.storage.errors import StoreError
from fairyring.storage.exporting import export_coco
from fairyring.storage.images import get_image
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import create_project
from fairyring.storage.records import Cap
from tests.support.exported import SQUARE, export, store


def test_the_folder_holds_one_json_file_and_the_photos(beds, out):
    store(beds, Cap(visible=[SQUARE]), image=3)
    document = export(beds, out)
    assert sorted(str(file.relative_to(out)) for file in out.rglob("*")) == [
        "images",
        "images/bed_10.png",
        "instances.json",
    ]
    (image,) = document["images"]
    assert (image["id"], image["file_name"], image["width"], image["height"]) == (3, "bed_10.png", 100, 80)
    assert (out / "images/bed_10.png").read_bytes() == (beds.images / "bed_10.png").read_bytes()


def test_a_photo_turned_by_exif_is_written_upright(project, tmp_path, out):
    exif = Image.Exif()
    exif[0x0112] = 6
    pixels = np.zeros((40, 60, 3), np.uint8)
    pixels[:20, :30] = 255
    Image.fromarray(pixels).save(tmp_path / "turned.jpg", exif=exif, quality=95)
    import_paths(project, [tmp_path / "turned.jpg"])
    store(project, Cap(visible=[[22.0, 2.0, 38.0, 2.0, 38.0, 28.0, 22.0, 28.0]]))
    (image,) = export(project, out)["images"]
    assert (image["width"], image["height"]) == (40, 60)
    plain = cv2.imread(str(out / "images/turned.jpg"), cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION)
    assert plain.shape == (60, 40, 3)
    # Turned clockwise, the bright top left quarter lies at the top right, where the annotation is.
    assert plain[2:28, 22:38].min() > 230
    assert plain[:, :18].max() < 25
    with create_project(tmp_path / "other") as other:
        assert import_paths(other, [out]).problems == []


def test_a_folder_that_holds_something_is_refused_and_left_alone(beds, out):
    out.mkdir()
    (out / "mine.txt").write_text("mine")
    with pytest.raises(StoreError, match="is not empty"):
        export_coco(beds, out)
    assert [file.name for file in out.iterdir()] == ["mine.txt"]


def test_an_empty_folder_is_filled(beds, out):
    out.mkdir()
    store(beds, Cap(visible=[SQUARE]))
    assert len(export(beds, out)["annotations"]) == 1


def test_an_export_that_fails_leaves_nothing_behind(beds, out, tmp_path):
    store(beds, Cap(visible=[SQUARE]))
    before = sorted(tmp_path.iterdir())

    def cancel(_done, _total, what):
        if what == "Writing labels":
            raise CancelledError

    with pytest.raises(CancelledError):
        export_coco(beds, out, progress=cancel)
    (beds.images / "bed_1.png").unlink()
    with pytest.raises(StoreError, match=r"bed_1\.png is gone; put the photo back"):
        export_coco(beds, out)
    assert sorted(tmp_path.iterdir()) == before


def test_an_image_whose_file_is_another_photo_is_left_out_and_named(beds, out):
    for image in (1, 2):
        store(beds, Cap(visible=[SQUARE]), image=image)
    with beds.read() as connection:
        wrong, other = (get_image(connection, number).file_name for number in (1, 2))
    (beds.images / wrong).write_bytes((beds.images / other).read_bytes())

    report = export_coco(beds, out)

    (sentence,) = report.left_out
    assert str(beds.images / wrong) in sentence
    assert (report.images, report.annotations) == (1, 1)
    assert [file.name for file in (out / "images").iterdir()] == [other]
    document = json.loads((out / "instances.json").read_text())
    assert [image["file_name"] for image in document["images"]] == [other]
    assert [annotation["image_id"] for annotation in document["annotations"]] == [2]


def test_where_every_photo_is_another_nothing_is_exported(beds, out):
    store(beds, Cap(visible=[SQUARE]), image=3)
    (beds.images / "bed_10.png").write_bytes(b"no photo at all")
    with pytest.raises(StoreError, match=r"Nothing was exported: .*bed_10\.png is no longer the photo"):
        export_coco(beds, out)
    assert not out.exists()
