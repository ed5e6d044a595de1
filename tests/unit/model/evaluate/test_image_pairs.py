"""Images of two files are paired by name, however tools changed it; what finds no partner is said."""

from __future__ import annotations

from typing import Any

import pytest

from fairyring.model.coco.document import document_of
from fairyring.model.evaluate.centre_figures import evaluate_centres
from fairyring.model.evaluate.masks import evaluate_masks
from fairyring.model.evaluate.pages import DocumentError
from tests.support.squares import HEIGHT, WIDTH

SQUARE = [[10, 10, 50, 10, 50, 50, 10, 50]]


def of_images(*names: str, scored: bool = False) -> dict[str, Any]:
    """A document with one cap in each image; the n-th is n px further right."""
    return {
        "images": [
            {"id": n, "file_name": name, "width": WIDTH, "height": HEIGHT} for n, name in enumerate(names, 1)
        ],
        "annotations": [
            {"id": n, "image_id": n, "segmentation": SQUARE, "center": [30, 30]}
            | ({"score": 0.9} if scored else {})
            for n in range(1, len(names) + 1)
        ],
    }


def pairing(predicted: Any, truth: Any) -> dict[str, Any]:
    masks = evaluate_masks(document_of(predicted), document_of(truth))
    centres = evaluate_centres(document_of(predicted), document_of(truth))
    assert centres["pairing"] == masks["pairing"] | {"apart": 0}
    return masks["pairing"] | {"matched": masks["counts"]["matched"]}


def test_names_are_the_same_whatever_a_tool_puts_before_them_escapes_or_decomposes() -> None:
    truth = of_images("a bed.png", "b\u00fcro.png", "c.png")
    said = of_images("deep/a%20bed.png", "bu\u0308ro.png", "0123abcd-c.png", scored=True)
    assert pairing(said, truth) == {
        "unpredicted": [],
        "unknown": [],
        "renamed": {"a%20bed.png": "a bed.png", "0123abcd-c.png": "c.png"},
        "matched": 3,
    }


def test_folders_decide_where_a_base_name_comes_twice() -> None:
    truth = of_images("train/a.png", "valid/a.png", "b.png")
    assert pairing(of_images("x/valid/a.png", "x/train/a.png", "b.png"), truth)["matched"] == 3
    alone = pairing(of_images("a.png", "b.png"), truth)
    assert alone == {
        "unpredicted": ["train/a.png", "valid/a.png"],
        "unknown": ["a.png"],
        "renamed": {},
        "matched": 1,
    }


def test_an_exact_name_goes_before_one_that_only_may_be_meant() -> None:
    found = pairing(of_images("0123abcd-c.png", "c.png"), of_images("c.png"))
    assert (found["unknown"], found["renamed"]) == (["0123abcd-c.png"], {})


def test_which_of_two_is_meant_is_not_guessed_on_either_side() -> None:
    two, one = of_images("x/a.png", "y/a.png", "b.png"), of_images("a.png", "b.png")
    assert pairing(two, one) == {
        "unpredicted": ["a.png"],
        "unknown": ["x/a.png", "y/a.png"],
        "renamed": {},
        "matched": 1,
    }
    uploads = of_images("0123abcd-b.png", "4567abcd-b.png", "a.png")
    assert pairing(uploads, one)["unknown"] == ["0123abcd-b.png", "4567abcd-b.png"]


@pytest.mark.parametrize("names", [("x/a.png", "y/a.png"), ("y/a.png", "x/a.png")])
def test_the_folder_that_only_one_side_needs_decides(names: tuple[str, str]) -> None:
    found = pairing(of_images(*names), of_images("beds/y/a.png"))
    assert (found["unknown"], found["unpredicted"], found["matched"]) == (["x/a.png"], [], 1)


@pytest.mark.parametrize(
    ("predicted", "said"),
    [
        (of_images("x.png", "y.png"), "predictions are of x.png and 1 more, the truth of a.png"),
        ([{"image_id": 5, "segmentation": SQUARE, "score": 1}], "the list is of image 5"),
    ],
)
def test_no_image_in_common_is_an_error(predicted: Any, said: str) -> None:
    for evaluate in (evaluate_masks, evaluate_centres):
        with pytest.raises(DocumentError, match=f"no image in common.*{said}"):
            evaluate(document_of(predicted), document_of(of_images("a.png")))


def test_a_list_that_found_nothing_is_no_error() -> None:
    assert evaluate_masks(document_of([]), document_of(of_images("a.png")))["counts"]["missed"] == 1
