"""One annotation means the same to an import, to an evaluation and to ``contour``.

Each row is an annotation and what is wrong with it, if anything. Who reads the key in question hears that
very sentence and does what it always does: an import reports it and takes the rest, an evaluation stops and
names the annotation, ``contour`` keeps the annotation with the sentence as its refusal.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Any

import pytest

from fairyring.model.coco.document import Document, parse_document
from fairyring.model.coco.writing import shape_keys
from fairyring.model.contour.coco import contour_document
from fairyring.model.errors import FairyringError
from fairyring.model.evaluate.caps import cap_of
from fairyring.model.evaluate.centre_figures import CapPairing, evaluate_centres
from fairyring.model.evaluate.masks import evaluate_masks
from fairyring.storage.formats.coco import parse_coco
from fairyring.storage.formats.found import FoundCap
from fairyring.storage.importing.cap_checks import check_caps
from fairyring.storage.importing.photos import Photo

SQUARE = [10, 10, 30, 10, 30, 30, 10, 30]
TRIANGLE = [50, 50, 60, 50, 55, 60]
NAN, INFINITY = math.nan, math.inf
IMAGE = {"id": 1, "file_name": "bed.png", "width": 100, "height": 80}

IMPORT, MASKS, CENTRES, BY_ID, CONTOUR = "import", "masks", "centres", "by id", "contour"
PIXELS = (IMPORT, MASKS, CENTRES, CONTOUR)
"""Who reads the segmentation."""
SHAPES = (IMPORT, MASKS, CENTRES, BY_ID)
"""Who reads whole outlines, flags and scores: all but ``contour``, which works out its own."""
EVERYBODY = (*PIXELS, BY_ID)


@dataclass(frozen=True, kw_only=True)
class Row:
    """An annotation beside a good one."""

    keys: dict[str, Any]
    said: str = ""
    """What is wrong with it, a part of the sentence; nothing where it is good."""
    to: tuple[str, ...] = ()
    """Who hears it."""
    is_kept: bool = False
    """An import takes it all the same."""


def seen(segmentation: Any, said: str = "", **how: Any) -> Row:
    return Row(keys={"segmentation": segmentation}, said=said, to=PIXELS if said else (), **how)


def square(keys: dict[str, Any], said: str = "", to: tuple[str, ...] = SHAPES, **how: Any) -> Row:
    return Row(keys={"segmentation": [SQUARE], **keys}, said=said, to=to if said else (), **how)


THREE = "A polygon needs at least three points"
NUMBERS = "A polygon's coordinates must be numbers"
FINITE = "A polygon's coordinates must be finite numbers"
RADIUS = "A radius must be at least 0.25 px"
ROWS = {
    "a flat list is one part": seen(SQUARE),
    "one bad part of two": seen(
        [SQUARE, [1, 1, 2, 2]], "A polygon needs at least three points", is_kept=True
    ),
    "a part that is a number": seen([SQUARE, 5], "A polygon must be a flat list", is_kept=True),
    "a part that is null": seen([SQUARE, None], "A polygon must be a flat list", is_kept=True),
    "points in pairs": seen([[[10, 10], [30, 10], [30, 30], [10, 30]]], NUMBERS),
    "an empty part": seen([[]], THREE),
    "an odd number of coordinates": seen([[10, 10, 30, 10, 20]], "A polygon must be a flat list"),
    "NaN": seen([[10, 10, 30, 10, NAN, 30]], FINITE),
    "infinity": seen([[10, 10, 30, 10, INFINITY, 30]], FINITE),
    "a number of 401 digits": seen([[10, 10, 30, 10, 10**400, 30]], FINITE),
    "a boolean for a number": seen([[10, 10, 30, 10, True, 30]], NUMBERS),
    "a text for a number": seen([[10, 10, 30, 10, "30", 30]], NUMBERS),
    "null for a number": seen([[10, 10, 30, 10, None, 30]], NUMBERS),
    "far outside the image": seen([[500, 500, 510, 500, 505, 510]], "far outside the image"),
    "beside the image": seen([[110, 10, 120, 10, 115, 20]], "A polygon lies outside the image"),
    "without area": seen([[10, 10, 20, 20, 30, 30]], "A polygon has no area"),
    "a text": seen("many", "Its segmentation is neither a list of polygons nor an RLE"),
    "a number": seen(7, "Its segmentation is neither a list of polygons nor an RLE"),
    "RLE of another size": seen({"size": [3, 3], "counts": [0, 9]}, "not of the image's size, 100 × 80"),
    "RLE that does not add up": seen({"size": [80, 100], "counts": [1, 2]}, "do not add up"),
    "RLE without counts": seen({"size": [80, 100]}, "lacks its size or its counts"),
    "RLE of booleans": seen({"size": [80, 100], "counts": [True] * 8000}, "must be whole numbers"),
    "an RLE of a square": seen({"size": [80, 100], "counts": [810, *[20, 60] * 19, 20, 5650]}),
    "nothing seen and nothing drawn": seen([], "outline"),
    "nothing but a box": Row(keys={"bbox": [10, 10, 20, 20]}, said="outline", to=(MASKS, CENTRES, CONTOUR)),
    "null beside a circle": Row(
        keys={"segmentation": None, "circle": [20, 20, 10]}, said="no visible outline", to=(CONTOUR,)
    ),
    "nothing beside an ellipse": Row(
        keys={"ellipse": [20, 20, 10, 9, 0], "score": 0.5}, said="no visible outline", to=(CONTOUR,)
    ),
    "nothing beside a marked polygon": Row(keys={"mark": SQUARE}, said="no visible outline", to=(CONTOUR,)),
    "a negative radius": square({"circle": [20, 20, -5]}, RADIUS),
    "a radius of nothing": square({"circle": [20, 20, 0]}, RADIUS),
    "an axis of nothing": square({"ellipse": [20, 20, 5, 0, 0]}, RADIUS),
    "a circle far away": square({"circle": [1e9, 20, 5]}, "far outside the image"),
    "the shorter axis first": square({"ellipse": [20, 20, 9, 10, 0]}),
    "an angle beyond 180°": square({"ellipse": [20, 20, 10, 9, 361]}),
    "a circle of two numbers": square({"circle": [1, 2]}, "Its circle is not 3 finite numbers"),
    "a circle of texts": square({"circle": ["1", "2", "3"]}, "Its circle is not 3 finite numbers"),
    "an ellipse of keys": square({"ellipse": {"cx": 1}}, "Its ellipse is not 5 finite numbers"),
    "an ellipse and a circle": square({"ellipse": [25, 25, 9, 8, 0], "circle": [20, 20, 10]}),
    "shapes that are null": square({"circle": None, "ellipse": None, "center": None, "mark": None}),
    "a centre of NaN": square({"center": [1, NAN]}, "Its center is not 2", (IMPORT, CENTRES, BY_ID)),
    "a centre of booleans": square({"center": [True, 1]}, "Its center is not 2", (IMPORT, CENTRES, BY_ID)),
    "a centre far away": square({"center": [1e9, 20]}, "A centre lies far", (IMPORT, CENTRES, BY_ID)),
    "ignored, in words": square({"ignored": "yes"}, "“ignored” is neither true nor false"),
    "ignored by half": square({"ignore": 0.5}, "“ignore” is neither true nor false"),
    "crowds of two": square({"iscrowd": 2}, "“iscrowd” is neither true nor false", EVERYBODY),
    "a crowd of lists": square({"iscrowd": []}, "“iscrowd” is neither true nor false", EVERYBODY),
    "ignored is 0.0": square({"ignored": 0.0}),
    "no crowd, as text": square({"iscrowd": "0"}),
    "a score in words": square({"score": "high"}, "Its score is not a finite number"),
    "a score that is true": square({"score": True}, "Its score is not a finite number"),
    "a score that is null": square({"score": None}),
    "a category that is not listed": square({"category_id": 9}, "There is no category 9", (IMPORT,)),
    "no category where there is one only": square({"category_id": None}),
    "the category as a float": square({"category_id": 1.0}),
    "the category as text": square({"category_id": "1"}),
    "the image as a float": square({"image_id": 1.0}),
    "the image as text": square({"image_id": "1"}),
    "the image as text of a float": square({"image_id": "1.0"}),
    "an id of half a character": square({"id": "\ud800"}),
    "an order in words": square({"order": "first"}, "“order” is not a whole number", (IMPORT,), is_kept=True),
    "an order of 3.0": square({"order": 3.0}),
    "a mark that is none": square({"mark": "A"}, "Its mark is not a polygon", (IMPORT,)),
}
GOOD = {name: row for name, row in ROWS.items() if not row.said}


def document_with(keys: dict[str, Any]) -> dict[str, Any]:
    first = {"id": 1, "image_id": 1, "category_id": 1, **keys}
    second = {"id": 2, "image_id": 1, "category_id": 1, "segmentation": [TRIANGLE]}
    return {
        "images": [IMAGE],
        "annotations": [first, second],
        "categories": [{"id": 1, "name": "mushroom"}],
    }


TRUTH = document_with({"segmentation": [SQUARE], "center": [20, 20]})
OF_EACH = pytest.mark.parametrize("row", ROWS.values(), ids=ROWS.keys())


def parsed(document: dict[str, Any]) -> Document:
    return parse_document(json.dumps(document).encode())


def imported(document: dict[str, Any]) -> tuple[list[FoundCap], list[tuple[str, str]]]:
    """The caps an import takes, and its complaints: where, and why."""
    found = parse_coco(json.dumps(document).encode(), file="f.json")
    photo = Photo(file_name="bed.png", width=100, height=80, sha256="")
    caps, problems = check_caps(found.images[0].caps, photo=photo, file="f.json")
    return caps, [(problem.where, problem.reason) for problem in (*found.problems, *problems)]


@OF_EACH
def test_an_import_reports_it_and_takes_the_rest(row: Row) -> None:
    caps, complaints = imported(document_with(row.keys))
    assert [cap.where for cap in caps][-1] == "annotation 2"
    assert len(caps) == (2 if row.is_kept or IMPORT not in row.to else 1)
    assert len(complaints) == (IMPORT in row.to)
    for where, reason in complaints:
        assert where == "annotation 1"
        assert row.said in reason


@OF_EACH
@pytest.mark.parametrize("how", [MASKS, CENTRES, BY_ID])
def test_an_evaluation_stops_and_names_it(row: Row, how: str) -> None:
    evaluate = {
        MASKS: evaluate_masks,
        CENTRES: evaluate_centres,
        BY_ID: lambda predicted, truth: evaluate_centres(predicted, truth, CapPairing(by="id")),
    }[how]
    document = document_with(row.keys)
    if how not in row.to:
        evaluate(parsed(document), parsed(TRUTH))
        return
    for sides in ((document, TRUTH), (TRUTH, document)):
        with pytest.raises(FairyringError, match=r"Annotation 1 of bed\.png: ") as stopped:
            evaluate(*map(parsed, sides))
        assert row.said in str(stopped.value)


@OF_EACH
def test_contour_keeps_it_with_the_reason(row: Row) -> None:
    document = document_with(row.keys)
    first, second = contour_document(parsed(document), method="enclosing")["annotations"]
    # As far from (50, 50) as from (60, 50) and (55, 60); its pixels end a little inside.
    assert second["center"] == pytest.approx([55, 53.75], abs=0.6)
    others = {key: value for key, value in row.keys.items() if key not in ("center", "circle", "ellipse")}
    assert json.dumps({key: first[key] for key in others}) == json.dumps(others)
    if CONTOUR in row.to:
        assert first["center"] is None
        assert row.said in first["refusal"]
    else:
        assert first["center"] == pytest.approx([20, 20], abs=0.25)


@pytest.mark.parametrize("row", GOOD.values(), ids=GOOD.keys())
def test_what_all_take_is_the_same_cap_to_all(row: Row) -> None:
    (cap, _), _ = imported(document_with(row.keys))
    stored = {"segmentation": cap.cap.visible or None, **shape_keys_of(cap)}
    first, second = (
        cap_of({**keys}, width=100, height=80, masks=True, centres=True) for keys in (row.keys, stored)
    )
    assert first.rle == second.rle
    if isinstance(row.keys["segmentation"], list):
        assert first.centre == pytest.approx(second.centre)


def shape_keys_of(cap: FoundCap) -> dict[str, Any]:
    """The whole outline that an import takes, in the keys of an export."""
    return {} if cap.whole is None else shape_keys(cap.whole)


IGNORED = [{key: yes} for key in ("iscrowd", "ignore", "ignored") for yes in (1, True, 1.0, "1", "true")]


@pytest.mark.parametrize("flag", IGNORED, ids=str)
def test_all_agree_on_what_is_ignored(flag: dict[str, Any]) -> None:
    document = document_with({"segmentation": [SQUARE], **flag})
    (cap, other), complaints = imported(document)
    assert (cap.cap.ignored, other.cap.ignored, complaints) == (True, False, [])
    assert evaluate_masks(parsed(TRUTH), parsed(document))["counts"]["ignored"] == 1
    first, _ = contour_document(parsed(document), method="enclosing")["annotations"]
    # A crowd is several caps and has no centre; another cap that does not count has one.
    assert (first["center"] is None) == ("iscrowd" in flag)


NO_IMAGE = [None, 7, True, 1.5, [1], {}, "bed.png"]


@pytest.mark.parametrize("image_id", NO_IMAGE, ids=str)
def test_an_annotation_of_no_image_keeps_no_other_out(
    image_id: Any,
) -> None:
    document = document_with({"segmentation": [SQUARE], "image_id": image_id})
    caps, complaints = imported(document)
    assert [cap.where for cap in caps] == ["annotation 2"]
    assert len(complaints) == 1
    first, second = contour_document(parsed(document), method="enclosing")["annotations"]
    assert (first["center"], second["center"] is None) == (None, False)
    assert "no such image" in first["refusal"]
    if image_id in (7, "bed.png"):
        # Only the images of the truth count; others may be named.
        assert evaluate_masks(parsed(document), parsed(TRUTH))["counts"]["predictions"] == 1
    else:
        with pytest.raises(FairyringError, match="does not say which image"):
            evaluate_masks(parsed(document), parsed(TRUTH))


SIZES = [{"width": 100.0, "height": 80.0}, {"id": 1.0}, {"id": "1"}, {"light": "\ud800"}, {"light": "sun"}]


@pytest.mark.parametrize("keys", SIZES, ids=str)
def test_an_image_through_a_spreadsheet_is_the_same_image(keys: dict[str, Any]) -> None:
    document = document_with({"segmentation": [SQUARE]})
    document["images"] = [IMAGE | keys]
    caps, _ = imported(document)
    assert len(caps) == 2
    assert evaluate_centres(parsed(document), parsed(TRUTH))["matched"] == 2
    found = contour_document(parsed(document), method="enclosing")["annotations"]
    assert found[0]["center"] == pytest.approx([20, 20], abs=0.25)


NO_IMAGES = [
    ({"width": "100"}, "The width is not a positive whole number"),
    ({"height": -1}, "The height is not a positive whole number"),
    ({"height": True}, "The height is not a positive whole number"),
    ({"id": None}, "The id is missing"),
    ({"id": True}, "The id is missing"),
]


@pytest.mark.parametrize(("keys", "said"), NO_IMAGES)
def test_an_image_that_makes_no_sense_takes_its_caps_with_it(keys: dict[str, Any], said: str) -> None:
    document = document_with({"segmentation": [SQUARE]})
    document["images"] = [IMAGE | keys, {**IMAGE, "id": 2, "file_name": "other.png"}]
    found = parse_coco(json.dumps(document).encode(), file="f.json")
    assert [(image.file_name, image.caps) for image in found.images] == [("other.png", [])]
    assert said in found.problems[0].reason
    with pytest.raises(FairyringError, match=rf"Image .*: {said}"):
        evaluate_masks(parsed(document), parsed(TRUTH))
    refusals = [cap["refusal"] for cap in contour_document(parsed(document))["annotations"]]
    assert all("no such image" in refusal for refusal in refusals)


@pytest.mark.parametrize("categories", [None, [], {}, "none"])
def test_without_a_list_of_categories_all_are_mushrooms(categories: Any) -> None:
    document = {**document_with({"segmentation": [SQUARE]}), "categories": categories}
    caps, complaints = imported(document)
    assert [cap.cap.category for cap in caps] == ["mushroom"] * 2
    assert complaints == []
