"""Caps as a file gives them: outlines, marks, categories, and what of them cannot be used."""

import math
import re

import pytest

from fairyring.model.geometry.raster import rle_of_mask
from fairyring.model.geometry.shapes import Circle, Ellipse, area_of_outline
from fairyring.storage.errors import StoreError
from fairyring.storage.images import ImageFilter, list_images
from fairyring.storage.importing.paths import import_paths
from tests.support.imported import annotations_of, reasons
from tests.support.masks import disc, peppered
from tests.unit.storage.conftest import TRIANGLE


def test_marks_become_whole_outlines_at_once(beds, write_coco, square):
    file = write_coco(
        [
            {"segmentation": square, "circle": [20, 20, 11]},
            {"segmentation": TRIANGLE, "ellipse": [50, 46, 9, 8, 5], "center": [50, 46]},
            {"segmentation": [], "circle": [70, 60, 5]},
            {"segmentation": [[1, 1, 9, 1, 9, 9, 1, 9]], "center": [5.5, 5]},
        ]
    )
    report = import_paths(beds, [file])
    assert report.problems == []
    circle, ellipse, unseen, centre = annotations_of(beds)
    assert (circle.cap.mark, circle.whole, circle.centre) == (
        Circle(20, 20, 11),
        Circle(20, 20, 11),
        (20, 20),
    )
    assert ellipse.cap.mark == ellipse.whole == Ellipse(50, 46, 9, 8, 5)
    assert (unseen.cap.visible, unseen.cap.mark) == ([], Circle(70, 60, 5))
    # A square of 8 × 8 has the area of a circle of radius 8/√π.
    assert centre.cap.mark == Circle(5.5, 5.0, pytest.approx(8 / math.sqrt(math.pi)))


def test_a_center_beside_its_circle_is_reported(beds, write_coco, square):
    file = write_coco([{"segmentation": square, "circle": [20, 20, 11], "center": [23, 24]}])
    report = import_paths(beds, [file])
    assert report.annotations == 1
    assert reasons(report) == ["Its center lies 5.0 px from that of its circle or ellipse, which was taken."]


def test_a_noisy_mask_is_taken_without_its_specks_and_that_is_said(beds, write_coco):
    whole = disc(50, 40, 30)
    rle = rle_of_mask(peppered(whole, 0.02))

    report = import_paths(beds, [write_coco([{"segmentation": rle}])])

    (cap,) = annotations_of(beds)
    assert area_of_outline(cap.cap.visible) == pytest.approx(whole.sum(), rel=0.02)
    (reason,) = reasons(report)
    assert re.fullmatch(r"[0-9]+ specks and holes of a few pixels were left out of its noisy mask\.", reason)
    with pytest.raises(StoreError, match="specks"):
        import_paths(beds, [write_coco([{"segmentation": rle}])], strict=True)


BAD_OUTLINES = [
    [[10, 10, 20, 20]],
    [[10, 10, 20, 20, 30]],
    [[10, 10, 20, 10, math.nan, 20]],
    [[10, 10, 20, 10, math.inf, 20]],
    [[10, 10, 20, 10, 1e30, 20]],
    [[10, 10, 20, 10, True, 20]],
    [[10, 10, 20, 10, "15", 20]],
    [[10, 10, 20, 20, 30, 30]],
    [[500, 500, 510, 500, 505, 510]],
    [[]],
    [],
    {"size": [81, 100], "counts": [0, 8100]},
]


@pytest.mark.parametrize("outline", BAD_OUTLINES, ids=str)
def test_an_outline_that_cannot_be_used_is_reported_and_the_others_taken(beds, write_coco, square, outline):
    report = import_paths(beds, [write_coco([{"segmentation": outline}, {"segmentation": square}])])
    assert report.annotations == 1
    (problem,) = report.problems
    assert problem.where == "annotation 1"
    assert annotations_of(beds)[0].cap.visible == square


def test_a_bad_part_is_left_out_and_the_rest_of_the_cap_kept(beds, write_coco, square):
    report = import_paths(beds, [write_coco([{"segmentation": [*square, [1, 1, 2, 2]]}])])
    assert annotations_of(beds)[0].cap.visible == square
    assert reasons(report) == ["Part 2 was left out: A polygon needs at least three points."]


def test_categories_are_made_as_they_come(beds, write_coco, square):
    categories = [{"id": 1, "name": "mushroom"}, {"id": 5, "name": "button", "supercategory": "fungus"}]
    file = write_coco([{"segmentation": square, "category_id": 5}], categories=categories)
    import_paths(beds, [file])
    assert annotations_of(beds)[0].cap.category == "button"


def test_the_counters_follow_an_import(beds, write_coco, square):
    import_paths(beds, [write_coco([{"segmentation": square}, {"segmentation": TRIANGLE, "ignore": True}])])
    with beds.read() as connection:
        row = list_images(connection, ImageFilter(search="bed_1.png")).rows[0]
    assert (row.caps, row.ignored) == (1, 1)


def test_of_caps_with_one_outline_in_a_file_the_first_is_taken_and_the_others_are_told(
    beds, write_coco, square
):
    twice = {"segmentation": square}
    other = {"segmentation": square, "category_id": 2}
    categories = [{"id": 1, "name": "mushroom"}, {"id": 2, "name": "bud"}]
    report = import_paths(beds, [write_coco([twice, twice, other], categories=categories)])
    assert (report.annotations, report.known) == (1, 0)
    assert [(each.where, each.reason) for each in report.problems] == [
        (f"annotation {n}", "It has the outline of annotation 1, which was taken.") for n in (2, 3)
    ]
    assert [each.cap.category for each in annotations_of(beds)] == ["mushroom"]
