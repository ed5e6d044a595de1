"""Figures of the centres of two COCO documents, as the command gives them."""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
import pytest

from fairyring.model.coco.document import document_of
from fairyring.model.errors import FairyringError
from fairyring.model.evaluate.centre_figures import CapPairing, evaluate_centres
from fairyring.model.evaluate.pages import DocumentError
from fairyring.model.geometry.raster import rle_of_mask
from fairyring.model.geometry.shapes import Circle, polygon_of_shape

WIDTH, HEIGHT = 200, 100


def document(*annotations: dict[str, Any], name: str = "beds/a.jpg", image_id: int = 7) -> dict[str, Any]:
    return {
        "images": [{"id": image_id, "file_name": name, "width": WIDTH, "height": HEIGHT}],
        "annotations": [{"id": i, "image_id": image_id, **a} for i, a in enumerate(annotations, start=1)],
        "categories": [{"id": 1, "name": "mushroom"}],
    }


def figures_of(predicted: Any, truth: Any, **how: Any) -> dict[str, Any]:
    return evaluate_centres(document_of(predicted), document_of(truth), CapPairing(**how))


def disc(cx: float, cy: float, r: float = 15.0) -> list[list[float]]:
    return [polygon_of_shape(Circle(cx, cy, r), chord_error=0.02)]


def test_the_command_s_figures_have_the_agreed_shape() -> None:
    truth = document(
        {"segmentation": disc(50, 50), "circle": [50, 50, 15]},
        {"segmentation": disc(120, 50), "center": [120, 50]},
    )
    predicted = document({"segmentation": disc(52, 51), "center": [52, 51]}, name="a.jpg", image_id=1)

    figures = msgspec.json.decode(msgspec.json.encode(figures_of(predicted, truth)))

    # |2| / 200 + |1| / 100 = 2 %; √5 px, over 30 px.
    spread = {"mean": pytest.approx(2.0), "median": pytest.approx(2.0), "p95": pytest.approx(2.0)}
    assert [figures.pop(key).keys() for key in ("intervals", "groups")] == [
        {"cdr", "px", "relative"},
        {"size", "visibility", "light", "form"},
    ]
    assert [row["outcome"] for row in figures.pop("caps")] == ["matched", "missed"]
    assert figures == {
        "cdr": spread,
        "px": dict.fromkeys(("mean", "median", "p95"), pytest.approx(5**0.5)),
        "relative": dict.fromkeys(("mean", "median", "p95"), pytest.approx(5**0.5 / 30)),
        "bias_px": [2.0, 1.0],
        "matched": 1,
        "missed": 1,
        "extra": 0,
        "images": [{"file_name": "a.jpg", "cdr_mean": pytest.approx(2.0), "count": 1}],
        "pairing": {"unpredicted": [], "unknown": [], "renamed": {}, "apart": 0},
    }


@pytest.mark.parametrize(
    ("keys", "centre"),
    [
        ({"center": [48, 47], "circle": [49, 46, 15], "ellipse": [50, 45, 15, 14, 0]}, (48, 47)),
        ({"center": None, "circle": [49, 46, 15], "ellipse": [50, 45, 15, 14, 0]}, (49, 46)),
        ({"ellipse": [50, 45, 15, 14, 0]}, (50, 45)),
        ({}, (51, 44)),
    ],
)
def test_a_centre_is_center_then_the_circle_s_then_the_ellipse_s_then_fitted(
    keys: dict[str, Any], centre: tuple[float, float]
) -> None:
    truth = document({"segmentation": disc(51, 44), "center": [0, 0]})
    predicted = document({"segmentation": disc(51, 44), **keys})

    figures = figures_of(predicted, truth)

    assert figures["bias_px"] == pytest.approx(centre, abs=1e-3)


def test_the_centre_of_a_mask_is_fitted_to_its_rim_in_continuous_coordinates() -> None:
    rows, columns = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    rle = rle_of_mask((columns - 51.5) ** 2 + (rows - 44.5) ** 2 < 15**2)
    truth = document({"segmentation": disc(51.5, 44.5), "center": [51.5, 44.5]})

    figures = figures_of(document({"segmentation": rle}), truth)

    assert figures["bias_px"] == pytest.approx((0, 0), abs=0.02)


def test_pairing_by_id_reads_no_segmentation() -> None:
    truth = document(
        {"center": [50, 50]}, {"center": [120, 50]}, {"center": [9, 9]}, {"ignore": True, "center": [1, 1]}
    )
    predicted = document(
        {"center": [50, 51], "segmentation": "nonsense"}, {"center": None, "refusal": "too small"}
    )
    predicted["annotations"] += [
        {"id": 4, "image_id": 7, "center": [90, 90]},
        {"id": 99, "image_id": 7, "center": [5, 5]},
    ]

    figures = figures_of(predicted, truth, by="id")

    # 1 is paired, 2 was refused, 3 is not there, 4 is ignored, 99 is nobody's.
    assert (figures["matched"], figures["missed"], figures["extra"]) == (1, 2, 1)
    assert figures["cdr"]["mean"] == pytest.approx(1.0)


def test_a_refused_cap_is_missed_though_its_mask_fits() -> None:
    truth = document({"segmentation": disc(50, 50), "center": [50, 50]})
    predicted = document({"segmentation": disc(50, 50), "center": None, "refusal": "nothing but border"})

    figures = figures_of(predicted, truth)

    assert (figures["matched"], figures["missed"], figures["extra"]) == (0, 1, 0)
    assert figures["cdr"]["mean"] is None


@pytest.mark.parametrize("flag", ["ignore", "ignored", "iscrowd"])
def test_every_spelling_of_ignored_is_understood(flag: str) -> None:
    truth = document({"segmentation": disc(50, 50), flag: 1})

    figures = figures_of(document({"segmentation": disc(50, 50)}), truth)

    assert (figures["matched"], figures["missed"], figures["extra"]) == (0, 0, 0)


def test_a_list_of_results_goes_by_the_other_side_s_image_ids() -> None:
    truth = document({"segmentation": disc(50, 50), "center": [50, 50]})
    results = [{"image_id": 7, "category_id": 1, "score": 0.9, "segmentation": disc(50, 50)}]

    assert figures_of(results, truth)["matched"] == 1
    assert figures_of(truth, results)["matched"] == 1
    with pytest.raises(DocumentError, match="sizes are needed"):
        figures_of(results, results)


def test_only_the_truth_s_images_count() -> None:
    truth = document({"segmentation": disc(50, 50), "center": [50, 50]})
    both = document({"segmentation": disc(50, 50), "center": [50, 50]})
    both["images"].append({**both["images"][0], "id": 8, "file_name": "other.jpg"})
    both["annotations"].append({**both["annotations"][0], "id": 2, "image_id": 8})

    figures = figures_of(both, truth)

    assert (figures["matched"], figures["missed"], figures["extra"]) == (1, 0, 0)
    assert figures["pairing"]["unknown"] == ["other.jpg"]


def two_images_of_one_name() -> dict[str, Any]:
    twice = document()
    twice["images"].append({**twice["images"][0], "id": 8})
    return twice


def of_another_size() -> dict[str, Any]:
    other = document()
    other["images"][0]["width"] = 1
    return other


@pytest.mark.parametrize(
    ("predicted", "reason"),
    [
        (None, "neither a COCO file"),
        ({"images": {}}, "neither a COCO file"),
        ([{"segmentation": []}], "which image"),
        (two_images_of_one_name(), "Another image of this file is called .*a.jpg too"),
        (of_another_size(), "different sizes"),
        (document({"segmentation": [[1, 1, 5, 5]]}), "Annotation 1 of a.jpg: .*three points"),
        (document({"segmentation": None}), "Annotation 1 of a.jpg"),
        (document({"segmentation": {"size": [5, 5], "counts": [0, 25]}}), "not of the image's size"),
        (document({"segmentation": disc(50, 50), "center": [1, float("nan")]}), "center is not 2 finite"),
        (document({"segmentation": disc(50, 50), "circle": [1, True, 3]}), "circle is not 3 finite"),
        (document({"segmentation": disc(50, 50), "ellipse": "round"}), "ellipse is not 5 finite"),
    ],
)
def test_what_cannot_be_evaluated_is_refused_with_its_place(predicted: Any, reason: str) -> None:
    with pytest.raises(FairyringError, match=reason):
        figures_of(predicted, document({"segmentation": disc(50, 50)}))


def test_pairing_by_id_needs_ids_that_differ() -> None:
    truth = document({"center": [1, 1]}, {"center": [2, 2]})
    twice = document({"center": [1, 1]}, {"center": [2, 2], "id": 1})

    with pytest.raises(DocumentError, match="an id each"):
        figures_of(twice, truth, by="id")
    with pytest.raises(DocumentError, match="an id each"):
        figures_of([{"image_id": 7, "center": [1, 1]}], truth, by="id")
