"""What the document says of each cap, and that other libraries can read it."""

import math

import faster_coco_eval
import numpy as np
import pytest
from pycocotools import mask
from pycocotools.coco import COCO

from fairyring.model.geometry.shapes import Circle, Ellipse
from fairyring.storage.records import Cap
from tests.support.exported import SQUARE, TRIANGLE, export, store


def test_ids_count_from_1_in_one_stable_order(beds, out, tmp_path):
    store(beds, Cap(visible=[TRIANGLE]), Cap(visible=[SQUARE]), image=2)
    store(beds, Cap(visible=[SQUARE]), image=1)
    document = export(beds, out)
    assert [image["file_name"] for image in document["images"]] == ["bed_1.png", "bed_2.png"]
    assert [(a["id"], a["image_id"], a["uid"]) for a in document["annotations"]] == [
        (1, 1, "1_0"),
        (2, 2, "2_0"),
        (3, 2, "2_1"),
    ]
    assert [category["id"] for category in document["categories"]] == [1]
    export(beds, tmp_path / "again")
    assert (tmp_path / "again/instances.json").read_bytes() == (out / "instances.json").read_bytes()


def test_box_area_and_polygons_are_of_one_geometry(beds, out):
    store(beds, Cap(visible=[SQUARE, TRIANGLE]))
    (annotation,) = export(beds, out)["annotations"]
    assert annotation["segmentation"] == [SQUARE, TRIANGLE]
    assert annotation["bbox"] == [10, 10, 50, 50]
    assert annotation["area"] == 20 * 20 + 20 * 20 / 2
    assert annotation["iscrowd"] == 0
    assert "ignore" not in annotation


def test_a_marked_centre_is_visible_and_a_reconstructed_one_is_not(beds, out):
    store(beds, Cap(visible=[SQUARE], mark=Circle(20, 21, 11)), whole=Circle(20, 21, 11), centre=(20.0, 21.0))
    store(beds, Cap(visible=[SQUARE]), image=2, whole=Ellipse(19, 20, 12, 11, 30), centre=(19.0, 20.0))
    store(beds, Cap(visible=[SQUARE]), image=3)
    marked, worked_out, unknown = export(beds, out)["annotations"]
    assert (marked["center"], marked["circle"], marked["marked"]) == ([20, 21], [20, 21, 11], True)
    assert (marked["keypoints"], marked["num_keypoints"]) == ([19.5, 20.5, 2], 1)
    assert (worked_out["ellipse"], worked_out["marked"]) == ([19, 20, 12, 11, 30], False)
    assert worked_out["keypoints"] == [18.5, 19.5, 1]
    assert (unknown["center"], unknown["keypoints"], unknown["num_keypoints"]) == (None, [0, 0, 0], 0)


def test_the_whole_outline_and_how_much_is_hidden(beds, out):
    store(beds, Cap(visible=[SQUARE]), whole=Circle(20, 20, 20), centre=(20.0, 20.0))
    (annotation,) = export(beds, out)["annotations"]
    points = np.reshape(annotation["amodal_segmentation"][0], (-1, 2))
    assert np.hypot(*(points - 20).T) == pytest.approx(20, abs=1e-3)
    assert annotation["occlude_rate"] == pytest.approx(1 - 400 / (math.pi * 20**2), abs=0.01)


def test_a_circle_without_an_outline_is_drawn_within_a_tenth_of_a_pixel(beds, out):
    store(beds, Cap(visible=[], mark=Circle(50, 40, 30)))
    (annotation,) = export(beds, out)["annotations"]
    points = np.reshape(annotation["segmentation"][0], (-1, 2))
    chords = (points + np.roll(points, 1, axis=0)) / 2
    assert np.hypot(*(chords - (50, 40)).T).min() >= 30 - 0.1 - 1e-3
    assert annotation["segmentation_of"] == "mark"


@pytest.mark.parametrize("loader", [COCO, faster_coco_eval.COCO])
def test_other_libraries_load_an_export(beds, out, loader):
    store(beds, Cap(visible=[SQUARE, TRIANGLE]), Cap(visible=[], mark=Circle(50, 40, 9)))
    export(beds, out, with_ignored=True)
    coco = loader(str(out / "instances.json"))
    areas = [int(mask.area(coco.annToRLE(annotation))) for annotation in coco.loadAnns(coco.getAnnIds())]
    # A square of 20 px, half a box of 20 px, and a disc of 9 px.
    assert areas[0] == pytest.approx(600, abs=12)
    assert areas[1] == pytest.approx(math.pi * 81, abs=8)
