import pytest

from fairyring.model.geometry.shapes import Circle, Fit
from fairyring.storage.contents import load_contents
from fairyring.storage.derived import (
    Underived,
    count_underived,
    images_with_underived,
    store_derived,
    underived_of,
)
from fairyring.storage.journal import Derived, commit
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.records import Cap, Edit
from tests.support.stored import stored_annotation

FIT = Fit(whole=Circle(20, 20, 10), centre=(20.0, 20.0))


@pytest.fixture
def lacking(beds, square):
    """Image 1 with an annotation and a prediction, image 2 with a deleted annotation."""

    def predict(connection):
        run = add_run(connection, name="r", kind="simulated")
        new = [NewPrediction(visible=square, score=0.5)]
        add_predictions(connection, run_id=run.id, image_id=1, predictions=new)

    def edit(number, annotation, image, base, cap):
        return Derived(edit=Edit(id=number, annotation=annotation, image=image, base=base, cap=cap))

    beds.write(predict)
    cap = Cap(visible=square)
    commit(
        beds, [edit("1", "a", 1, 0, cap), edit("2", "b", 2, 0, cap), edit("3", "b", 2, 1, None)], user="ann"
    )
    return beds


def test_what_lacks_a_whole_outline_is_found_until_it_is_stored(lacking):
    with lacking.read() as connection:
        assert images_with_underived(connection) == [1]
        assert underived_of(connection, 1) == Underived(annotations=["a"], predictions={1: [1]})
        assert underived_of(connection, 2) == Underived(annotations=[], predictions={})

    def store(connection):
        return store_derived(connection, 1, annotations={("a", 1): FIT}, predictions={1: FIT})

    assert lacking.write(store) == 2
    with lacking.read() as connection:
        contents = load_contents(connection, 1)
        assert images_with_underived(connection) == []
    for cap in (*contents.annotations, *contents.predictions):
        assert (cap.whole, cap.centre) == (FIT.whole, FIT.centre)
    assert lacking.write(store) == 0


def test_a_refused_fit_is_not_tried_again_until_the_cap_is_edited(lacking, square):
    refused = Fit(refusal="too little of it is in sight")
    lacking.write(lambda c: store_derived(c, 1, annotations={("a", 1): refused}, predictions={1: Fit()}))
    with lacking.read() as connection:
        assert images_with_underived(connection) == []
    commit(
        lacking,
        [Derived(edit=Edit(id="9", annotation="a", image=1, base=1, cap=Cap(visible=square)))],
        user="ann",
    )
    with lacking.read() as connection:
        assert underived_of(connection, 1).annotations == ["a"]


def test_a_fit_of_an_older_revision_is_dropped(lacking, square):
    later = Edit(id="9", annotation="a", image=1, base=1, cap=Cap(visible=square))
    commit(lacking, [Derived(edit=later)], user="ann")
    assert lacking.write(lambda c: store_derived(c, 1, annotations={("a", 1): FIT})) == 0
    with lacking.read() as connection:
        assert stored_annotation(connection, "a").whole is None


def test_predictions_of_an_older_run_are_found_too(lacking, square):
    def later(connection):
        run = add_run(connection, name="later", kind="simulated")
        new = [NewPrediction(visible=square, score=0.5)]
        add_predictions(connection, run_id=run.id, image_id=1, predictions=new)

    lacking.write(later)
    with lacking.read() as connection:
        assert underived_of(connection, 1).predictions == {1: [1], 2: [2]}


def test_what_is_lacking_is_counted_and_found_among_some_images(lacking):
    with lacking.read() as connection:
        assert count_underived(connection) == 2
        assert images_with_underived(connection, [2]) == []
        assert images_with_underived(connection, [2, 1]) == [1]
