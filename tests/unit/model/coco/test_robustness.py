"""Whatever a document holds, it is read or refused in words, and what is good beside it is taken."""

from __future__ import annotations

import json
from contextlib import suppress
from functools import partial
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from fairyring.model.coco.document import document_of, objects_of, parse_document
from fairyring.model.coco.faults import Fault
from fairyring.model.contour.coco import contour_document
from fairyring.model.contour.estimate import estimate_priors
from fairyring.model.errors import FairyringError
from fairyring.model.evaluate.centre_figures import CapPairing, evaluate_centres
from fairyring.model.evaluate.masks import evaluate_masks
from fairyring.storage.formats.coco import parse_coco
from fairyring.storage.importing.cap_checks import check_caps
from fairyring.storage.importing.photos import Photo

SQUARE = [10, 10, 30, 10, 30, 30, 10, 30]
IMAGE = {"id": 1, "file_name": "bed.png", "width": 64, "height": 48}
ELSEWHERE = [40, 20, 50, 20, 50, 30, 40, 30]
GOOD = {"id": 77, "image_id": 1, "category_id": 1, "segmentation": [ELSEWHERE]}
CATEGORIES = [{"id": 1, "name": "mushroom"}]

numbers = st.sampled_from([0, 1, -1, 2, 10, 20.5, -5, 1e9, 1e308, 10**30, 10**400])
odd = st.none() | st.booleans() | numbers | st.floats() | st.text(max_size=4) | st.just("\ud800")
anything = st.recursive(
    odd,
    lambda inner: st.lists(inner, max_size=8) | st.dictionaries(st.text(max_size=4), inner, max_size=3),
    max_leaves=12,
)
parts = st.lists(st.lists(numbers | odd, max_size=10) | anything, max_size=4)
rles = st.fixed_dictionaries(
    {
        "size": st.sampled_from([[48, 64], [1 << 20, 1 << 20], [48, 64.0], [0, 0], None]) | anything,
        "counts": st.sampled_from([[3072], [1000, 72, 2000], "PPl0"])
        | st.lists(numbers | odd, max_size=6)
        | anything,
    }
)
KEYS = {
    "id": anything,
    "image_id": st.just(1) | anything,
    "category_id": st.just(1) | anything,
    "segmentation": st.just([SQUARE]) | parts | rles | anything,
    "amodal_segmentation": parts | anything,
    "mark": st.lists(numbers | odd, max_size=10) | anything,
    "circle": st.lists(numbers | odd, min_size=3, max_size=3) | anything,
    "ellipse": st.lists(numbers | odd, min_size=5, max_size=5) | anything,
    "center": st.lists(numbers | odd, min_size=2, max_size=2) | anything,
    "bbox": st.lists(numbers | odd, min_size=4, max_size=4) | anything,
    **dict.fromkeys(("iscrowd", "ignore", "ignored", "doubt", "marked", "score", "order"), odd | anything),
    **dict.fromkeys(("uid", "segmentation_of", "refusal", "center_sd", "note"), anything),
}
annotations = st.fixed_dictionaries({}, optional=KEYS) | anything
images = st.fixed_dictionaries(
    {},
    optional={
        "id": st.just(2) | anything,
        **dict.fromkeys(("width", "height"), numbers | odd),
        "file_name": st.text(max_size=6) | anything,
        **dict.fromkeys(("light", "form", "split", "license"), anything),
    },
)
entries = st.lists(annotations, max_size=3)
ROUNDS = settings(max_examples=60)


def document_with(bad: list[Any], **keys: Any) -> dict[str, Any]:
    return {"images": [IMAGE], "annotations": [*bad, GOOD], "categories": CATEGORIES, **keys}


def text_of(document: Any) -> bytes:
    return json.dumps(document).encode()


@ROUNDS
@given(bad=entries)
@example(bad=[{"image_id": 1, "segmentation": [SQUARE, 5]}])
@example(bad=[{"image_id": 1, "segmentation": {"size": [48, 64], "counts": [3072]}}])
def test_an_import_takes_the_good_annotation_beside_the_bad_one(bad: list[Any]) -> None:
    found = parse_coco(text_of(document_with(bad)), file="f.json")
    photo = Photo(file_name="bed.png", width=64, height=48, sha256="")
    caps, problems = check_caps(found.images[0].caps, photo=photo, file="f.json")
    assert caps[-1].where == "annotation 77"
    assert caps[-1].cap.visible == [list(map(float, ELSEWHERE))]
    for problem in (*found.problems, *problems):
        str(problem).encode()
    json.dumps([cap.extra for cap in caps], allow_nan=False).encode()


@ROUNDS
@given(bad=entries)
def test_contour_answers_the_good_annotation_beside_the_bad_one(bad: list[Any]) -> None:
    found = contour_document(parse_document(text_of(document_with(bad))), method="enclosing")
    assert len(found["annotations"]) == len(bad) + 1
    assert found["annotations"][-1]["center"] == pytest.approx([45, 25], abs=0.3)
    assert all(cap["refusal"] for cap in found["annotations"] if isinstance(cap, dict) and not cap["center"])


@ROUNDS
@given(bad=entries, more=st.lists(images | anything, max_size=2), whole=anything)
@example(bad=[{"image_id": "\ud800"}], more=[], whole=None)
def test_an_evaluation_ends_in_figures_or_in_one_sentence(
    bad: list[Any], more: list[Any], whole: Any
) -> None:
    truth = parse_document(text_of(document_with([])))
    for predicted in (document_with(bad), document_with(bad, images=[IMAGE, *more]), bad, whole):
        for evaluate in (
            evaluate_masks,
            evaluate_centres,
            partial(evaluate_centres, pairing=CapPairing(by="id")),
            lambda document, _: estimate_priors(document, source="x"),
        ):
            try:
                evaluate(parse_document(text_of(predicted)), truth)
            except FairyringError as error:
                str(error).encode()


@ROUNDS
@given(more=st.lists(images | anything, max_size=3), categories=anything)
def test_whatever_its_other_lists_hold_a_file_is_imported_or_refused(
    more: list[Any], categories: Any
) -> None:
    document = document_with([], images=[*more, IMAGE], categories=categories, licenses=categories)
    found = parse_coco(text_of(document), file="f.json")
    assert all(image.where for image in found.images)
    for problem in found.problems:
        str(problem).encode()


@ROUNDS
@given(st.binary(max_size=60) | anything.map(lambda value: json.dumps(value).encode()))
def test_any_bytes_are_a_document_or_refused(data: bytes) -> None:
    with suppress(FairyringError):
        document = parse_document(data)
        list(objects_of("annotation", document.annotations, report=lambda _: None))


@ROUNDS
@given(bad=entries)
def test_text_and_what_is_decoded_already_are_read_alike(bad: list[Any]) -> None:
    def told(document: Any) -> list[Any]:
        faults: list[Fault] = []
        found = objects_of("annotation", document.annotations, report=faults.append)
        return [repr(list(found)), faults]

    document = document_with(bad)
    assert told(parse_document(text_of(document))) == told(document_of(json.loads(text_of(document))))
