"""An annotation as it is written: its keys, of one geometry, as other programs read them."""

from __future__ import annotations

import math

import pytest
from pycocotools import mask as pycocotools_mask

from fairyring.model.coco.writing import (
    MARKED,
    centre_keys,
    occlusion_keys,
    outline_keys,
    rounded,
    rounded_outline,
    shape_keys,
    whole_keys,
)
from fairyring.model.geometry.shapes import Circle, Ellipse

SQUARE = [10.0, 10.0, 30.0, 10.0, 30.0, 30.0, 10.0, 30.0]
TRIANGLE = [50.0, 50.0, 60.0, 50.0, 55.0, 60.0]


def test_box_and_area_are_of_the_outline_as_it_is_written() -> None:
    entry = outline_keys(rounded_outline([SQUARE, TRIANGLE]))
    assert entry == {"segmentation": [SQUARE, TRIANGLE], "bbox": [10, 10, 50, 50], "area": 450}
    fine = outline_keys(rounded_outline([[0.00004, 0, 3, 0, 3, 1.00006]]))
    assert (fine["segmentation"], fine["bbox"]) == ([[0.0, 0.0, 3.0, 0.0, 3.0, 1.0001]], [0, 0, 3, 1.0001])
    assert fine["area"] == pytest.approx(1.5, abs=2e-4)


def test_what_was_rounded_once_stays_the_same() -> None:
    once = rounded([math.pi, 1e6 / 3, -2 / 3])
    assert once == [3.1416, 333333.3333, -0.6667]
    assert rounded(once) == once


def test_a_circle_and_an_ellipse_have_keys_of_their_own() -> None:
    assert shape_keys(Circle(1, 2, 3.00004)) == {"circle": [1, 2, 3]}
    assert shape_keys(Ellipse(1, 2, 4, 3, 30)) == {"ellipse": [1, 2, 4, 3, 30]}


def test_half_of_a_whole_circle_is_hidden_where_half_of_it_is_seen() -> None:
    entry = whole_keys(Circle(100, 100, 50), visible_area=math.pi * 50**2 / 2)
    (whole,) = entry["amodal_segmentation"]
    (code,) = pycocotools_mask.frPyObjects([whole], 200, 200)
    assert pycocotools_mask.area(code) == pytest.approx(math.pi * 50**2, rel=0.01)
    assert entry["occlude_rate"] == pytest.approx(0.5, abs=0.005)
    assert "occlude_rate" not in whole_keys(Circle(100, 100, 50), visible_area=None)


@pytest.mark.parametrize(("share", "rate"), [(0.25, 0.75), (1.0, 0.0), (1.02, 0.0), (0.0, 1.0)])
def test_more_than_nothing_is_never_hidden_of_what_is_all_in_sight(share: float, rate: float) -> None:
    assert occlusion_keys(share) == {"occlude_rate": rate}


def test_the_keypoint_is_the_centre_in_pixel_indices() -> None:
    assert centre_keys((10.5, 20.25), visibility=MARKED) == {
        "center": [10.5, 20.25],
        "keypoints": [10.0, 19.75, 2],
        "num_keypoints": 1,
    }
    assert centre_keys(None, visibility=MARKED) == {
        "center": None,
        "keypoints": [0, 0, 0],
        "num_keypoints": 0,
    }
