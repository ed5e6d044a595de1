"""The rows of single caps, groups of them, what a pair needs, and two runs against each other."""

from __future__ import annotations

from typing import Any

import pytest

from fairyring.model.coco.document import document_of
from fairyring.model.evaluate.centre_figures import CapPairing, evaluate_centres, evaluated, truth_to_pair
from fairyring.model.evaluate.two_runs import difference_of

IMAGE = {"id": 1, "file_name": "a.png", "width": 400, "height": 200, "light": "dark", "form": "c"}


def square(x: float, side: float = 40) -> list[list[float]]:
    return [[x, 20, x + side, 20, x + side, 20 + side, x, 20 + side]]


def document(*annotations: dict[str, Any], **image: Any) -> Any:
    numbered = [{"id": n, "image_id": 1, **a} for n, a in enumerate(annotations, start=1)]
    return document_of({"images": [IMAGE | image], "annotations": numbered})


def rows(predicted: Any, truth: Any, **how: Any) -> list[dict[str, Any]]:
    caps = evaluate_centres(predicted, truth, CapPairing(**how))["caps"]
    return [{name: getattr(row, name) for name in row.__struct_fields__} for row in caps]


def test_a_row_says_which_caps_these_are_how_far_apart_and_of_what_kind() -> None:
    truth = document(
        {"segmentation": square(100), "circle": [120, 40, 25], "marked": True, "occlude_rate": 0.25}
    )
    predicted = document({"id": 9, "segmentation": square(104), "center": [123, 44], "score": 0.75})

    (row,) = rows(predicted, truth)

    assert row == {
        "image": "a.png",
        "outcome": "matched",
        "truth": 1,
        "prediction": 9,
        "dx": 3.0,
        "dy": 4.0,
        "px": 5.0,
        # 3 / 400 + 4 / 200 = 2.75 %
        "cdr": pytest.approx(2.75),
        "relative": 0.1,
        "diameter": 50.0,
        "visible_share": 0.75,
        # 40 × 40 px in sight, of 32² and 96².
        "size": "m",
        "shape": None,
        "mark": "circle",
        "score": 0.75,
        # 36 of 44 columns.
        "iou": pytest.approx(36 / 44),
    }


def test_missed_and_extra_caps_have_rows_without_an_error() -> None:
    found = rows(
        document({"segmentation": square(300), "score": 0.5}),
        document({"segmentation": square(10), "center": [30, 40]}),
    )
    assert [(row["outcome"], row["truth"], row["prediction"], row["px"]) for row in found] == [
        ("missed", 1, None, None),
        ("extra", None, 1, None),
    ]


@pytest.mark.parametrize(
    ("keys", "mark"),
    [
        ({"mark": [100, 20, 140, 20, 120, 60], "ellipse": [120, 40, 22, 20, 0]}, "polygon"),
        ({"ellipse": [120, 40, 22, 20, 0]}, "ellipse"),
        ({"center": [120, 40]}, "centre"),
        ({"circle": [120, 40, 20], "marked": False}, None),
        ({}, None),
    ],
)
def test_a_row_says_what_the_true_centre_was_taken_from(keys: dict[str, Any], mark: str | None) -> None:
    truth = document({"segmentation": square(100), **keys})
    assert [row["mark"] for row in rows(truth, truth)] == [mark]


def test_what_is_in_sight_is_as_stated_else_of_the_stated_whole_outline_else_not_known() -> None:
    truth = document(
        {"segmentation": square(10), "circle": [30, 40, 40], "occlude_rate": 0.5},
        # 1600 px of a circle of 40 px: 5026.5 px².
        {"segmentation": square(100), "circle": [120, 40, 40]},
        {"segmentation": square(200)},
    )
    shares = [row["visible_share"] for row in rows(truth, truth)]
    assert shares == [0.5, pytest.approx(0.3183, abs=1e-4), None]


def test_pairs_by_id_take_area_and_share_from_what_the_file_says() -> None:
    truth = document({"center": [30, 40], "circle": [30, 40, 40], "area": 1600.0})
    (row,) = rows(truth, truth, by="id")
    assert (row["size"], row["visible_share"], row["iou"]) == ("m", pytest.approx(0.3183, abs=1e-4), None)


def test_groups_are_of_size_visibility_light_and_form() -> None:
    truth = document(
        {"segmentation": square(10, 30), "circle": [25, 35, 20], "occlude_rate": 0.5},
        {"segmentation": square(100), "circle": [120, 40, 20], "occlude_rate": 0.0},
        {"segmentation": square(200), "circle": [220, 40, 20], "occlude_rate": 0.3},
        {"segmentation": square(300, 20), "circle": [310, 30, 10], "occlude_rate": 0.0},
    )
    predicted = document(
        {"segmentation": square(10, 30), "center": [27, 35]},
        {"segmentation": square(100), "center": [124, 40]},
        {"segmentation": square(300, 20), "center": [310, 31]},
    )

    groups = evaluate_centres(predicted, truth)["groups"]

    shown = {
        kind: {
            value: (group["px"]["mean"], group["matched"], group["missed"]) for value, group in some.items()
        }
        for kind, some in groups.items()
    }
    assert shown == {
        "size": {"m": (4.0, 1, 1), "s": (2.0, 1, 0), "under_30_px": (1.0, 1, 0)},
        "visibility": {
            "60_to_95_percent": (None, 0, 1),
            "95_percent_and_more": (2.5, 2, 0),
            "under_60_percent": (2.0, 1, 0),
        },
        "light": {"dark": (pytest.approx(7 / 3), 3, 1)},
        "form": {"c": (pytest.approx(7 / 3), 3, 1)},
    }
    # Two caps are drawn from two, so that the mean of 4 and 1 lies between them.
    interval = groups["visibility"]["95_percent_and_more"]["intervals"]["px"]
    assert interval == {"mean": 2.5, "low": 1.0, "high": 4.0, "drawn": "caps", "count": 2}


def test_pairs_overlap_as_much_as_is_asked_and_unsure_predictions_are_left_out() -> None:
    truth = document({"segmentation": square(100), "center": [120, 40]})
    # 30 of 50 columns.
    predicted = document({"segmentation": square(110), "center": [130, 40], "score": 0.4})

    def outcomes(**how: Any) -> list[str]:
        return [row["outcome"] for row in rows(predicted, truth, **how)]

    assert outcomes() == ["matched"]
    assert outcomes(least_iou=0.59) == ["matched"]
    assert outcomes(least_iou=0.61) == ["missed", "extra"]
    assert outcomes(least_score=0.4) == ["matched"]
    assert outcomes(least_score=0.41) == ["missed"]


def test_two_runs_are_compared_on_the_caps_that_both_found() -> None:
    places = (10, 100, 200, 300)
    truth = document(*({"segmentation": square(x), "circle": [x + 20, 40, 20]} for x in places))

    def run(*errors: float | None) -> Any:
        found = zip(places, errors, strict=True)
        return document(
            *({"segmentation": square(x), "center": [x + 20, 40 + e]} for x, e in found if e is not None)
        )

    pairing = CapPairing()
    read = truth_to_pair(truth, pairing)
    first, second = (evaluated(each, read, pairing) for each in (run(1, 4, None, 2), run(2, 1, 9, None)))
    found = difference_of(first, second)

    counts = {key: value for key, value in found.items() if isinstance(value, int)}
    assert counts == {
        "both": 2,
        "only_first": 1,
        "only_second": 1,
        "neither": 0,
        "second_nearer": 1,
        "first_nearer": 1,
    }
    # 2 − 1 and 1 − 4 px; of 200 px, and over 40 px.
    assert found["px"] == {"mean": -1.0, "low": -3.0, "high": 1.0, "drawn": "caps", "count": 2}
    assert found["cdr"]["mean"] == pytest.approx(-0.5)
    assert found["relative"]["mean"] == pytest.approx(-0.025)
    assert found["groups"]["light"]["dark"]["both"] == 2
