import copy
import math

import numpy as np
import pytest

from fairyring.model.coco.document import document_of
from fairyring.model.contour.coco import contour_document
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.raster import mask_of_outline, rle_of_mask
from fairyring.model.geometry.shapes import Circle, polygon_of_shape

DISC = [polygon_of_shape(Circle(cx=80.0, cy=60.0, r=25))]


def uncompressed(mask: np.ndarray) -> dict:
    flat = mask.T.ravel()
    change = np.flatnonzero(np.diff(flat)) + 1
    return {"size": list(mask.shape), "counts": np.diff([0, *change, len(flat)]).tolist()}


def document() -> dict:
    mask = mask_of_outline(DISC, height=120, width=160)
    segmentations = [
        DISC,
        rle_of_mask(mask),
        uncompressed(mask),
        [[1.0, 1.0, 5.0]],
        {"size": [3, 3], "counts": [9]},
    ]
    return {
        "info": {"kept": True},
        "images": [{"id": 7, "file_name": "a.png", "width": 160, "height": 120}],
        "annotations": [
            {"id": 10 + i, "image_id": 7, "segmentation": s, "mine": i} for i, s in enumerate(segmentations)
        ],
    }


def contour(given: dict, **how) -> dict:
    return contour_document(document_of(given), **how)


@pytest.mark.parametrize("method", ["map", "paper", "literal", "ellipse", "hull", "enclosing"])
def test_polygons_and_both_kinds_of_rle_get_the_same_centre(method: str):
    given = document()
    given["annotations"] = given["annotations"][:1]
    first = contour(given, method=method)["annotations"][0]
    assert first["center"] == pytest.approx([80, 60], abs=0.25)
    assert ("circle" in first) != ("ellipse" in first)
    assert (first["center_sd"] is not None) == (method == "map")
    assert first["shape"] == "regular"
    for index in (1, 2):
        other = document()
        other["annotations"] = other["annotations"][index : index + 1]
        assert contour(other, method=method)["annotations"][0]["center"] == first["center"]


def test_annotations_keep_their_ids_keys_and_order_and_the_document_is_left_alone():
    given = document()
    before = copy.deepcopy(given)
    found = contour(given, method="enclosing")
    assert given == before
    assert [(a["id"], a["mine"]) for a in found["annotations"]] == [(10 + i, i) for i in range(5)]
    assert found["info"] == {"kept": True}


def test_what_is_no_mask_is_refused_and_stays():
    found = contour(document(), method="enclosing")["annotations"]
    assert [a["center"] is None for a in found] == [False, False, False, True, True]
    assert all(a["refusal"] for a in found[3:])
    assert "not of the image's size" in found[4]["refusal"]


def test_what_was_said_of_a_cap_before_is_replaced():
    given = document()
    given["annotations"] = [
        given["annotations"][0] | {"circle": [1, 2, 3], "ellipse": [1, 2, 3, 3, 0], "refusal": "x"}
    ]
    (found,) = contour(given)["annotations"]
    assert "circle" not in found
    assert "refusal" not in found
    assert found["ellipse"][:2] == found["center"]
    assert found["ellipse"][2] >= found["ellipse"][3]
    assert 0 <= found["ellipse"][4] < 180
    assert all(math.isfinite(figure) for figure in (*found["ellipse"], *found["center_sd"]))


@pytest.mark.parametrize("given", [[], {"images": {}}, {"images": [], "annotations": {}}, 5])
def test_what_is_no_coco_document_is_refused(given):
    with pytest.raises(FairyringError):
        contour(given)


@pytest.mark.parametrize(
    ("image", "annotation"),
    [
        ({"height": None}, {}),
        ({"width": -1}, {}),
        ({}, {"image_id": 2}),
        ({}, {"image_id": None}),
        ({"id": [1]}, {"image_id": [1]}),
        ({"id": 1.5}, {"image_id": 1.5}),
        ({"id": True}, {"image_id": True}),
    ],
)
def test_a_cap_without_a_proper_image_is_refused_where_it_stands(image: dict, annotation: dict):
    given = document()
    given["images"].append({"id": 8, "file_name": "b.png", "width": 160, "height": 120})
    given["images"][0] |= image
    given["annotations"] = [
        given["annotations"][0] | annotation | {"circle": [1, 2, 3]},
        given["annotations"][1] | {"image_id": 8},
    ]
    lost, found = contour(given, method="enclosing")["annotations"]
    assert (lost["id"], lost["center"], "circle" in lost) == (10, None, False)
    assert "no such image" in lost["refusal"]
    assert found["center"] == pytest.approx([80, 60], abs=0.25)


def test_what_is_no_object_stays_as_it_is():
    given = document()
    given["annotations"][1] = 5
    assert contour(given, method="enclosing")["annotations"][1] == 5


def test_a_document_without_annotations_is_written_with_none():
    given = document()
    del given["annotations"]
    assert contour(given)["annotations"] == []


def test_a_crowd_is_not_a_cap():
    given = document()
    given["annotations"] = [given["annotations"][1] | {"iscrowd": 1}]
    (found,) = contour(given)["annotations"]
    assert found["center"] is None
    assert "crowd" in found["refusal"]


def test_a_mask_torn_into_thousands_of_crumbs_is_judged_by_its_one_large_part():
    mask = mask_of_outline(DISC, height=120, width=160)
    mask[::2, 110::2] = 1
    given = document()
    given["annotations"] = [{"id": 1, "image_id": 7, "segmentation": rle_of_mask(mask)}]
    for method in ("map", "paper", "enclosing"):
        (found,) = contour(given, method=method)["annotations"]
        assert found["center"] == pytest.approx([80, 60], abs=0.25)
