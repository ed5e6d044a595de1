import copy
import math

import numpy as np
import pytest

from fairyring.model.contour.coco import ContourError, contour_document
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


@pytest.mark.parametrize("method", ["map", "paper", "literal", "ellipse", "hull", "enclosing"])
def test_polygons_and_both_kinds_of_rle_get_the_same_centre(method: str):
    given = document()
    given["annotations"] = given["annotations"][:1]
    first = contour_document(given, method=method)["annotations"][0]
    assert first["center"] == pytest.approx([80, 60], abs=0.25)
    assert ("circle" in first) != ("ellipse" in first)
    assert (first["center_sd"] is not None) == (method == "map")
    assert first["shape"] == "regular"
    for index in (1, 2):
        other = document()
        other["annotations"] = other["annotations"][index : index + 1]
        assert contour_document(other, method=method)["annotations"][0]["center"] == first["center"]


def test_annotations_keep_their_ids_keys_and_order_and_the_document_is_left_alone():
    given = document()
    before = copy.deepcopy(given)
    found = contour_document(given, method="enclosing")
    assert given == before
    assert [(a["id"], a["mine"]) for a in found["annotations"]] == [(10 + i, i) for i in range(5)]
    assert found["info"] == {"kept": True}


def test_what_is_no_mask_is_refused_and_stays():
    found = contour_document(document(), method="enclosing")["annotations"]
    assert [a["center"] is None for a in found] == [False, False, False, True, True]
    assert all(a["refusal"] for a in found[3:])
    assert "not of the image's size" in found[4]["refusal"]


def test_what_was_said_of_a_cap_before_is_replaced():
    given = document()
    given["annotations"] = [
        given["annotations"][0] | {"circle": [1, 2, 3], "ellipse": [1, 2, 3, 3, 0], "refusal": "x"}
    ]
    (found,) = contour_document(given)["annotations"]
    assert "circle" not in found
    assert "refusal" not in found
    assert found["ellipse"][:2] == found["center"]
    assert found["ellipse"][2] >= found["ellipse"][3]
    assert 0 <= found["ellipse"][4] < 180
    assert all(math.isfinite(figure) for figure in (*found["ellipse"], *found["center_sd"]))


@pytest.mark.parametrize(
    "given",
    [
        [],
        {"images": []},
        {"images": [{"id": 1, "width": 10}], "annotations": []},
        {"images": [{"id": 1, "width": 10, "height": 10}], "annotations": [{"image_id": 2}]},
    ],
    ids=["a list", "no annotations", "an image without height", "an annotation without image"],
)
def test_what_is_no_coco_document_is_refused(given):
    with pytest.raises(ContourError):
        contour_document(given)


def test_a_crowd_is_not_a_cap():
    given = document()
    given["annotations"] = [given["annotations"][1] | {"iscrowd": 1}]
    (found,) = contour_document(given)["annotations"]
    assert found["center"] is None
    assert "crowd" in found["refusal"]


@pytest.mark.parametrize("wrong", [[1], {}, None, 1.5])
def test_an_id_that_is_neither_a_number_nor_a_text_is_refused(wrong: object):
    of_image, of_annotation = document(), document()
    of_image["images"][0]["id"] = of_image["annotations"][0]["image_id"] = wrong
    of_annotation["annotations"][0]["image_id"] = wrong
    for given in (of_image, of_annotation):
        with pytest.raises(ContourError, match=r"lacks its id|does not belong"):
            contour_document(given, method="enclosing")


def test_a_mask_torn_into_thousands_of_crumbs_is_judged_by_its_one_large_part():
    mask = mask_of_outline(DISC, height=120, width=160)
    mask[::2, 110::2] = 1
    given = document()
    given["annotations"] = [{"id": 1, "image_id": 7, "segmentation": rle_of_mask(mask)}]
    for method in ("map", "paper", "enclosing"):
        (found,) = contour_document(given, method=method)["annotations"]
        assert found["center"] == pytest.approx([80, 60], abs=0.25)
