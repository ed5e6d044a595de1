"""``evaluate masks`` on whole documents: the keys it answers with, and what it refuses."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest

from fairyring.model.coco.document import document_of
from fairyring.model.errors import FairyringError
from fairyring.model.evaluate.masks import evaluate_masks
from fairyring.model.evaluate.pages import DocumentError
from tests.support.squares import HEIGHT, WIDTH, box, cap, scores


def document(*annotations: dict[str, Any], **image: Any) -> dict[str, Any]:
    known = {"id": 7, "file_name": "beds/a.png", "width": WIDTH, "height": HEIGHT, **image}
    return {
        "images": [known],
        "annotations": [{"id": i, "image_id": known["id"], **a} for i, a in enumerate(annotations, start=1)],
    }


def figures_of(predicted: Any, truth: Any) -> dict[str, Any]:
    return evaluate_masks(document_of(predicted), document_of(truth))


def square(x: float, y: float, side: float = 40) -> list[list[float]]:
    return [[x, y, x + side, y, x + side, y + side, x, y + side]]


def test_the_command_s_figures_have_the_agreed_keys() -> None:
    truth = document({"segmentation": square(0, 0)}, light="side", form="c")

    figures = json.loads(json.dumps(figures_of(document({"segmentation": square(0, 0)}, id=1), truth)))

    contract = {"AP", "AP50", "AP75", "AR", "P", "R", "S50", "S75", "S50_strict", "groups"}
    more = {"S50_small", "IoU85", "excursion", "best_f1", "score", "counts", "pairing"}
    assert set(figures) == contract | more
    assert figures["groups"]["light"] == {
        "side": {
            "AP": 1.0,
            "S50": 1.0,
            "S75": 1.0,
            "S50_strict": 1.0,
            "IoU85": 1.0,
            "excursion": 0.0,
            "count": 1,
        }
    }
    assert figures["best_f1"] == {"F1": 1.0, "score": 1.0, "P": 1.0, "R": 1.0}
    assert figures["score"] == 0.5


def test_polygons_and_run_lengths_are_the_same_masks_and_a_missing_score_is_1() -> None:
    truth = document({"segmentation": square(0, 0)}, {"segmentation": square(100, 0), "ignore": True})
    predicted = [
        {"image_id": 7, "segmentation": box(0, 0, 40, 40)},
        {"image_id": 7, "segmentation": box(100, 0, 40, 40), "score": None},
        {"image_id": 8, "segmentation": box(0, 0, 40, 40), "score": 0.9},
    ]

    figures = figures_of(predicted, truth)

    assert (figures["AP"], figures["P"], figures["S50"], figures["best_f1"]["score"]) == (1, 1, 1, 1)
    assert figures["counts"]["dropped"] == 1
    # The image that only the predictions know is not looked at.
    assert figures["counts"]["predictions"] == 2


def test_all_categories_are_one_class() -> None:
    truth = document({"segmentation": square(0, 0), "category_id": 1})
    predicted = document({"segmentation": square(0, 0), "category_id": 5, "score": 0.9})

    assert figures_of(predicted, truth)["AP"] == 1


def test_the_whole_cap_of_a_truth_file_decides_whether_it_is_small() -> None:
    hidden = document({"segmentation": square(0, 0, 20), "ellipse": [30, 30, 25, 16, 0]})
    assert figures_of([], hidden)["S50"] == 0

    # 2 √(16 · 14) = 29.9 px; the box is not asked.
    small = document(
        {"segmentation": square(0, 0, 20), "ellipse": [10, 10, 16, 14, 0], "bbox": [0, 0, 90, 90]}
    )
    assert (figures_of([], small)["S50"], figures_of([], small)["S50_small"]) == (None, 0)
    unstated = document({"segmentation": square(0, 0, 26), "bbox": [0, 0, 90, 90]})
    assert figures_of([], unstated)["S50_small"] == 0


@pytest.mark.parametrize("score", [math.nan, math.inf, "high", True, 10**400])
def test_a_score_that_is_no_finite_number_is_refused_with_its_place(score: Any) -> None:
    predicted = document({"segmentation": square(0, 0), "score": score})

    with pytest.raises(DocumentError, match=r"Annotation 1 of a\.png: Its score is not a finite") as refused:
        figures_of(predicted, document({"segmentation": square(0, 0)}))
    assert refused.value.side == "predicted"


def test_a_score_in_memory_is_checked_too() -> None:
    with pytest.raises(FairyringError, match=r"a\.png has a score"):
        scores([cap(0, 0)], [cap(0, 0, score=math.nan)])


def test_the_side_that_is_wrong_is_told() -> None:
    good, broken = document({"segmentation": square(0, 0)}), document({"segmentation": [[1, 2]]})

    with pytest.raises(DocumentError) as refused:
        figures_of(good, broken)
    assert refused.value.side == "truth"
    with pytest.raises(DocumentError) as refused:
        figures_of(good, document(width=9))
    assert refused.value.side is None


def test_no_image_is_nothing_to_evaluate() -> None:
    with pytest.raises(FairyringError, match="at least one"):
        figures_of([], {"images": [], "annotations": []})
