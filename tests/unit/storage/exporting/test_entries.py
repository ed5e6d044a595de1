"""What the document says of each cap, and that other libraries can read it."""

import math

import faster_coco_eval
import numpy as np
import pytest
from pycocotools import mask
from pycocotools.coco import COCO

from fairyring.model.geometry.shapes import Circle, Ellipse
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import Derived, commit
from fairyring.storage.records import Cap, Edit
from tests.support.exported import SQUARE, TRIANGLE, export, store


def test_images_and_their_caps_are_in_one_stable_order_with_ids_in_that_of_their_making(beds, out, tmp_path):
    store(beds, Cap(visible=[TRIANGLE]), Cap(visible=[SQUARE]), image=2)
    store(beds, Cap(visible=[SQUARE]), image=1)
    document = export(beds, out)
    assert [image["file_name"] for image in document["images"]] == ["bed_1.png", "bed_2.png"]
    assert [(a["id"], a["image_id"], a["uid"]) for a in document["annotations"]] == [
        (3, 1, "1_0"),
        (1, 2, "2_0"),
        (2, 2, "2_1"),
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


def test_what_is_visible_ends_where_the_photo_does_and_the_whole_cap_need_not(beds, out):
    # Photos of 100 × 80; a quarter of the square lies in one.
    store(
        beds,
        Cap(visible=[[-20.0, -20.0, 20.0, -20.0, 20.0, 20.0, -20.0, 20.0]]),
        Cap(visible=[], mark=Circle(100, 40, 20)),
        whole=Circle(0, 0, 20),
        centre=(0.0, 0.0),
    )
    seen, marked = export(beds, out)["annotations"]
    assert (seen["bbox"], seen["area"], seen["circle"]) == ([0, 0, 20, 20], 400, [0, 0, 20])
    assert min(seen["amodal_segmentation"][0]) < -19
    assert seen["occlude_rate"] == pytest.approx(1 - 400 / (math.pi * 20**2), abs=0.01)
    assert marked["bbox"] == pytest.approx([80, 20, 20, 40], abs=0.1)
    assert (marked["circle"], marked["segmentation_of"]) == ([100, 40, 20], "mark")


def test_a_mark_that_covers_no_pixel_of_the_photo_is_still_written(beds, out):
    store(beds, Cap(visible=[], mark=Circle(109.9, 40, 10)))
    (annotation,) = export(beds, out)["annotations"]
    left, top, width, height = annotation["bbox"]
    assert (left, left + width) == pytest.approx((99.9, 100), abs=1e-3)
    assert 38 < top < 40 < top + height < 42


def test_what_other_programs_said_of_its_geometry_goes_with_the_first_edit(beds, out, tmp_path, write_coco):
    geometry = {
        "i_bbox": [10, 10, 20, 20],
        "i_segm": [SQUARE],
        "amodal_segmentation": [SQUARE, TRIANGLE],
        "visible_fraction": 0.8,
        "centroid": {"x": 20, "y": 20},
        "hull": [[10, 10], [30, 10], [30, 30]],
        "somehow": [10, 10, 30, 30],
    }
    others = {"note": "by the door", "attributes": {"occluded": False, "variety": "brown"}, "tags": [1, 2]}
    import_paths(beds, [write_coco([{"segmentation": [SQUARE], **geometry, **others}])])
    (annotation,) = export(beds, out)["annotations"]
    assert annotation.items() >= (geometry | others).items()
    moved = [[value + 5 for value in SQUARE]]
    edit = Edit(id="e", annotation=annotation["uid"], image=1, base=1, cap=Cap(visible=moved))
    commit(beds, [Derived(edit=edit)], user="ann")
    (annotation,) = export(beds, tmp_path / "again")["annotations"]
    assert annotation["segmentation"] == moved
    assert not annotation.keys() & geometry.keys()
    assert (annotation["note"], annotation["tags"]) == ("by the door", [1, 2])
    assert annotation["attributes"] == {"variety": "brown"}


def test_a_refusal_of_long_ago_is_not_exported(beds, out, write_coco):
    import_paths(beds, [write_coco([{"segmentation": [SQUARE], "center": None, "refusal": "too small"}])])
    assert "refusal" not in export(beds, out)["annotations"][0]
