"""Predictions that lie on what people have labelled already are not offered to them again."""

import pytest

from fairyring.model.geometry.shapes import Circle
from fairyring.storage.contents import load_contents, load_predictions
from fairyring.storage.journal import Derived, commit
from fairyring.storage.open_predictions import offered
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.records import Annotation, Cap, Edit, Image, Prediction

BED = Image(id=1, file_name="bed.png", path="images/bed.png", width=100, height=80, sha256="")


def box(left, top, right, bottom):
    return [[float(v) for v in (left, top, right, top, right, bottom, left, bottom)]]


def is_offered(outline, *, beside=None, whole=None, **cap):
    """Whether a prediction is, in an image with one annotation: by default the box 10, 10 to 30, 30."""
    visible = cap.pop("visible", box(10, 10, 30, 30))
    person = Annotation(uid="a", image=1, revision=1, cap=Cap(visible=visible, **cap), whole=whole)
    seen = Prediction(id=7, run=1, image=1, visible=outline, score=0.9)
    return offered(BED, [person, *(beside or [])], [seen]) == [seen]


@pytest.mark.parametrize(
    ("outline", "expected"),
    [
        (box(10, 10, 30, 30), False),
        (box(16, 10, 36, 30), False),  # IoU 14/26
        (box(17, 10, 37, 30), True),  # IoU 13/27, and neither covers the other
        (box(10, 10, 30, 18), False),  # a slice of two fifths
        (box(10, 10, 30, 14), True),  # a slice of one fifth: another cap that lies on this one
        (box(10, 10, 30, 60), False),  # this cap and more, IoU 20/50
        (box(10, 10, 90, 80), True),  # this cap in front of a large one
        (box(30, 10, 50, 30), True),  # side by side
        (box(60, 40, 90, 70), True),
    ],
)
def test_a_prediction_that_lies_on_an_annotation_is_no_longer_open(outline, expected):
    assert is_offered(outline) is expected


def test_what_an_annotation_started_from_stays_so_that_undoing_opens_it_again():
    assert is_offered(box(10, 10, 30, 30), prediction=7)
    other = Annotation(uid="b", image=1, revision=1, cap=Cap(visible=box(10, 10, 30, 30)))
    assert is_offered(box(10, 10, 30, 30), prediction=7, beside=[other])


def test_a_mark_without_an_outline_covers_what_it_encloses():
    mark = Circle(20.0, 20.0, 10.0)
    assert not is_offered(box(11, 11, 29, 29), visible=[], mark=mark, whole=mark)
    assert is_offered(box(40, 11, 58, 29), visible=[], mark=mark, whole=mark)


def test_a_small_prediction_in_an_ignored_region_is_not_offered():
    assert not is_offered(box(10, 10, 14, 14), ignored=True)
    assert is_offered(box(28, 10, 32, 14), ignored=True), "half of it lies outside"


@pytest.fixture
def repredicted(beds, square):
    """A cap that was accepted from a first run, and a second run that sees it again, and another one."""

    def predict(connection):
        run = add_run(connection, name="r", kind="network")
        new = [NewPrediction(visible=outline, score=0.9) for outline in (square, box(60, 40, 80, 60))]
        add_predictions(connection, run_id=run.id, image_id=1, predictions=new)

    beds.write(predict)
    with beds.read() as connection:
        first = load_predictions(connection, 1)[0]
    make = Edit(id="e1", annotation="a", image=1, base=0, cap=Cap(visible=square, prediction=first.id))
    commit(beds, [Derived(edit=make)], user="Ada")
    beds.write(predict)
    return beds


def test_the_document_holds_what_is_left_to_say_and_the_store_keeps_all(repredicted):
    with repredicted.read() as connection:
        contents, said = load_contents(connection, 1), load_predictions(connection, 1)
    assert [p.visible for p in contents.predictions] == [box(60, 40, 80, 60)]
    assert len(said) == 2
    assert {p.run for p in said} == {2}


def test_a_prediction_is_offered_again_once_the_cap_above_it_is_deleted(repredicted):
    gone = Edit(id="e2", annotation="a", image=1, base=1, cap=None)
    commit(repredicted, [Derived(edit=gone)], user="Ada")
    with repredicted.read() as connection:
        assert len(load_contents(connection, 1).predictions) == 2
