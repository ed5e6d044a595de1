"""Edits that are refused in a sentence."""

import math

import pytest

from fairyring.model.geometry.shapes import Circle
from fairyring.storage.errors import StoreError
from fairyring.storage.journal import commit
from fairyring.storage.records import Cap, Refused
from tests.support.edits import edit, journal_rows, one
from tests.unit.storage.conftest import TRIANGLE


@pytest.mark.parametrize(
    ("wrong", "reason"),
    [
        ({"cap": Cap(visible=[])}, "needs a visible outline or a mark"),
        ({"cap": Cap(visible=[[0.0, 0.0, 9.0, 9.0]])}, "at least three points"),
        ({"cap": Cap(visible=[[0.0, 0.0, 9.0, math.nan, 5.0, 5.0]])}, "finite"),
        ({"cap": Cap(visible=[[0.0, 0.0, 9.0, math.inf, 5.0, 5.0]])}, "finite"),
        ({"cap": Cap(visible=[[True, 0.0, 9.0, 0.0, 5.0, 5.0]])}, "numbers"),
        ({"cap": Cap(visible=[[1.0, 1.0, 9.0, 9.0, 5.0, 5.0]])}, "no area"),
        ({"cap": Cap(visible=[[0.0, 0.0, 9e6, 0.0, 5.0, 5.0]])}, "far outside"),
        ({"cap": Cap(visible=[], mark=Circle(10, 10, -1))}, "radius"),
        ({"cap": Cap(visible=[], mark=Circle(10, math.nan, 1))}, "finite"),
        ({"cap": Cap(visible=TRIANGLE * 501)}, "501 parts; 500 are allowed"),
        ({"cap": Cap(visible=TRIANGLE, category="stone")}, "no category"),
        ({"cap": Cap(visible=TRIANGLE, prediction=7)}, "prediction"),
        ({"cap": Cap(visible=TRIANGLE, prediction=10**30)}, "prediction"),
        ({"cap": Cap(visible=TRIANGLE, order=10**30)}, "overlap order"),
        ({"cap": Cap(visible=TRIANGLE), "image": 99}, "no image number 99"),
        ({"cap": Cap(visible=TRIANGLE), "image": 10**30}, "no image number 1000"),
        ({"cap": Cap(visible=TRIANGLE), "base": 1}, "no such annotation"),
        ({"cap": None}, "never made"),
        ({"cap": Cap(visible=TRIANGLE), "number": ""}, "number of an edit"),
        ({"cap": Cap(visible=TRIANGLE), "number": "x" * 201}, "number of an edit"),
        ({"cap": Cap(visible=TRIANGLE), "annotation": "a\nb"}, "number of an annotation"),
    ],
)
def test_what_cannot_be_stored_is_refused_in_a_sentence(beds, wrong, reason):
    outcome = one(beds, **wrong)
    assert isinstance(outcome, Refused)
    assert reason in outcome.reason
    assert journal_rows(beds) == []


def test_another_edit_under_a_number_that_was_used_is_refused(beds, cap):
    one(beds, cap=cap)
    for other in (
        edit(cap=Cap(visible=TRIANGLE)),
        edit(cap=cap, annotation="other"),
        edit(cap=cap, base=1),
        edit(cap=cap, image=2),
        edit(cap=None),
    ):
        (outcome,) = commit(beds, [other], user="ann")
        assert isinstance(outcome, Refused)
        assert "Another edit has this number" in outcome.reason
    assert len(journal_rows(beds)) == 1


def test_an_annotation_cannot_be_moved_to_another_image(beds, cap):
    one(beds, cap=cap)
    assert "another image" in one(beds, "e2", base=1, cap=cap, image=2).reason


@pytest.mark.parametrize("user", ["", "x" * 201, "a\u202eb"])
def test_a_user_needs_a_name_that_can_be_shown(beds, cap, user):
    with pytest.raises(StoreError, match="name of a user"):
        one(beds, cap=cap, user=user)
