"""Which images and whose caps are exported."""

import pytest

from fairyring.storage.journal import Derived, commit
from fairyring.storage.records import Cap, Edit
from tests.support.exported import SQUARE, TRIANGLE, export, store


@pytest.mark.parametrize(
    ("only", "files", "scores"),
    [
        ("annotated", ["bed_1.png", "bed_2.png"], [None]),
        ("approved", ["bed_2.png"], []),
        ("predicted", ["bed_10.png"], [0.5]),
        ("all", ["bed_1.png", "bed_2.png", "bed_10.png"], [None, 0.5]),
    ],
)
def test_what_is_exported_is_what_was_asked_for(mixed, out, only, files, scores):
    document = export(mixed, out, only=only)
    assert [image["file_name"] for image in document["images"]] == files
    assert [annotation.get("score") for annotation in document["annotations"]] == scores


def test_a_prediction_carries_its_score_centre_and_shape(mixed, out):
    document = export(mixed, out, only="predicted")
    (annotation,) = document["annotations"]
    assert (annotation["score"], annotation["center"], annotation["circle"]) == (0.5, [50, 46], [50, 46, 9])
    assert document["info"]["run"]["name"] == "late"


def test_ignored_caps_stay_out_unless_they_are_asked_for(beds, out, tmp_path):
    store(beds, Cap(visible=[SQUARE]), Cap(visible=[TRIANGLE], ignored=True))
    assert [a["uid"] for a in export(beds, out)["annotations"]] == ["1_0"]
    kept = export(beds, tmp_path / "all", with_ignored=True)["annotations"]
    assert [(a["iscrowd"], a.get("ignored")) for a in kept] == [(0, None), (1, True)]


def test_deleted_caps_are_not_exported(beds, out):
    store(beds, Cap(visible=[SQUARE]), Cap(visible=[TRIANGLE]))
    commit(beds, [Derived(edit=Edit(id="d", annotation="1_0", image=1, base=1, cap=None))], user="ann")
    assert [a["uid"] for a in export(beds, out)["annotations"]] == ["1_1"]
