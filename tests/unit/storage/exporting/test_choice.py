"""Which images and whose caps are exported."""

import pytest

from fairyring.storage.errors import StoreError
from fairyring.storage.journal import Derived, commit
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.records import Cap, Edit
from tests.support.exported import SQUARE, TRIANGLE, export, store


@pytest.mark.parametrize(
    ("only", "files", "scores"),
    [
        ("annotated", ["bed_1.png", "bed_2.png"], [None]),
        ("approved", ["bed_2.png"], []),
        ("predicted", ["bed_1.png", "bed_2.png", "bed_10.png"], [0.5, 0.5, 0.5]),
        ("all", ["bed_1.png", "bed_2.png", "bed_10.png"], [None, 0.5]),
    ],
)
def test_what_is_exported_is_what_was_asked_for(mixed, out, only, files, scores):
    document = export(mixed, out, only=only)
    assert [image["file_name"] for image in document["images"]] == files
    assert [annotation.get("score") for annotation in document["annotations"]] == scores


def test_a_prediction_carries_its_score_quality_centre_and_shape(mixed, out):
    document = export(mixed, out, only="predicted")
    annotation = document["annotations"][-1]
    assert (annotation["score"], annotation["center"], annotation["circle"]) == (0.5, [50, 46], [50, 46, 9])
    assert annotation["quality"] == 0.875


def test_what_is_predicted_of_an_image_is_what_the_latest_run_that_saw_it_said(mixed, out):
    def predict_again(connection):
        run = add_run(connection, name="last", kind="simulated")
        again = [NewPrediction(visible=[SQUARE], score=0.75)]
        add_predictions(connection, run_id=run.id, image_id=2, predictions=again)

    mixed.write(predict_again)
    document = export(mixed, out, only="predicted")
    assert [(a["image_id"], a["score"]) for a in document["annotations"]] == [(1, 0.5), (2, 0.75), (3, 0.5)]
    assert [(run["name"], run["images"]) for run in document["info"]["runs"]] == [
        ("early", 1),
        ("late", 1),
        ("last", 1),
    ]


@pytest.mark.parametrize("said", ["early", "1"])
def test_one_run_is_exported_by_its_name_or_number_also_where_later_ones_saw_the_image(mixed, out, said):
    def predict_again(connection):
        run = add_run(connection, name="last", kind="simulated")
        again = [NewPrediction(visible=[SQUARE], score=0.75)]
        add_predictions(connection, run_id=run.id, image_id=2, predictions=again)

    mixed.write(predict_again)
    document = export(mixed, out, only="predicted", run=said)
    assert [(a["image_id"], a["score"]) for a in document["annotations"]] == [(1, 0.5), (2, 0.5)]
    assert document["info"]["run"]["name"] == "early"


def test_a_run_that_is_not_there_is_refused_with_those_that_are(mixed, out):
    with pytest.raises(StoreError, match=r"no run called lat\. The latest are late, early"):
        export(mixed, out, only="predicted", run="lat")
    assert not out.exists()


def test_ignored_caps_stay_out_unless_they_are_asked_for(beds, out, tmp_path):
    store(beds, Cap(visible=[SQUARE]), Cap(visible=[TRIANGLE], ignored=True))
    assert [a["uid"] for a in export(beds, out)["annotations"]] == ["1_0"]
    kept = export(beds, tmp_path / "all", with_ignored=True)["annotations"]
    assert [(a["iscrowd"], a.get("ignored")) for a in kept] == [(0, None), (1, True)]


def test_deleted_caps_are_not_exported(beds, out):
    store(beds, Cap(visible=[SQUARE]), Cap(visible=[TRIANGLE]))
    commit(beds, [Derived(edit=Edit(id="d", annotation="1_0", image=1, base=1, cap=None))], user="ann")
    assert [a["uid"] for a in export(beds, out)["annotations"]] == ["1_1"]
