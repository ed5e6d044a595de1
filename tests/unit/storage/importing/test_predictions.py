"""A file taken as predictions: a run of its own, which nobody has agreed on."""

import numpy as np
import pytest

from fairyring.model.geometry.shapes import Circle, Ellipse
from fairyring.storage.contents import (
    load_annotations,
    load_contents,
    load_latest_run,
    load_predictions,
    load_run,
)
from fairyring.storage.images import ImageFilter, list_images
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.predictions import latest_run
from fairyring.storage.runs import list_runs, predictions_by
from tests.unit.storage.conftest import TRIANGLE


def test_a_file_taken_as_predictions_is_a_run(beds, write_coco, square):
    file = write_coco(
        [
            {"segmentation": square, "score": 0.75, "ellipse": [20, 20, 10, 9, 0], "center": [20.5, 20]},
            {"segmentation": TRIANGLE},
        ]
    )
    report = import_paths(beds, [file], as_="predictions")
    assert (report.annotations, report.predictions) == (0, 2)
    with beds.read() as connection:
        first, second = load_predictions(connection, 1)
        run = load_run(connection, report.run)
        assert load_annotations(connection, 1) == []
    assert (first.score, first.whole, first.centre) == (0.75, Ellipse(20, 20, 10, 9, 0), (20.5, 20.0))
    assert (second.score, second.whole) == (1.0, None)
    assert (run.name, run.kind) == ("labels.json", "import")


def test_what_others_call_quality_is_kept_and_is_none_of_ours(beds, write_coco, square):
    file = write_coco(
        [
            {"segmentation": square, "score": 0.75, "quality": 0.5},
            {"segmentation": TRIANGLE, "score": 0.75, "quality": 87},
        ]
    )
    import_paths(beds, [file], as_="predictions")
    with beds.read() as connection:
        ours, theirs = load_predictions(connection, 1)
    assert (ours.quality, ours.extra) == (0.5, {})
    assert (theirs.quality, theirs.extra) == (None, {"quality": 87})


def test_the_same_predictions_again_add_nothing(beds, write_coco, square):
    file = write_coco([{"segmentation": square, "score": 0.5}])
    first = import_paths(beds, [file], as_="predictions")
    again = import_paths(beds, [file], as_="predictions")
    assert (again.predictions, again.known, again.run) == (0, 1, first.run)


def test_what_cannot_be_a_prediction_is_reported(beds, write_coco, square):
    file = write_coco(
        [
            {"segmentation": square, "score": 0.5},
            {"segmentation": TRIANGLE, "ignore": True},
            {"segmentation": [[70, 40, 90, 40, 80, 60]], "score": 50},
        ]
    )
    report = import_paths(beds, [file], as_="predictions")
    assert report.predictions == 1
    where = [(problem.file, problem.where) for problem in report.problems]
    assert where == [(str(file), "annotation 2"), (str(file), "annotation 3")]


def test_a_prediction_that_is_only_a_circle_is_seen_as_that_circle(beds, write_coco):
    import_paths(
        beds, [write_coco([{"segmentation": [], "circle": [50, 40, 20], "score": 0.5}])], as_="predictions"
    )
    with beds.read() as connection:
        (prediction,) = load_contents(connection, 1).predictions
    points = np.reshape(prediction.visible[0], (-1, 2))
    assert np.hypot(*(points - (50, 40)).T) == pytest.approx(20)


@pytest.fixture
def model(beds, write_coco, square, tmp_path):
    """The run of what a model said of the bed."""
    file = write_coco([{"segmentation": square, "score": 0.5}], path=tmp_path / "model.json")
    return import_paths(beds, [file], as_="predictions").run


@pytest.fixture
def bens(write_coco, tmp_path):
    """What Ben labelled on it."""
    return write_coco([{"segmentation": TRIANGLE}], path=tmp_path / "ben.json")


def test_what_a_second_annotator_labelled_stands_beside_the_latest_run_and_is_not_it(beds, bens, model):
    report = import_paths(beds, [bens], as_="second")
    with beds.read() as connection:
        assert load_run(connection, report.run).kind == "second"
        assert latest_run(connection).id == model
        assert load_latest_run(connection, 1).id == model
        assert [each.run for each in load_contents(connection, 1).predictions] == [model]
        assert [each.visible for each in predictions_by(connection, report.run, 1)] == [TRIANGLE]
        assert [(row.run.name, row.images, row.latest_of) for row in list_runs(connection)] == [
            ("model.json", 1, 1),
            ("ben.json", 1, 0),
        ]


def test_a_project_that_no_model_saw_has_no_latest_run_by_a_second_annotator(beds, bens):
    import_paths(beds, [bens], as_="second")
    with beds.read() as connection:
        assert latest_run(connection) is None
        assert load_latest_run(connection, 1) is None
        assert load_contents(connection, 1).predictions == []


def test_imported_again_as_what_it_is_a_version_changes_its_kind_and_nothing_is_doubled(beds, bens, model):
    first = import_paths(beds, [bens], as_="predictions")
    assert first.unscored
    with beds.read() as connection:
        assert load_latest_run(connection, 1).id == first.run
    second = import_paths(beds, [bens], as_="second")
    assert (second.run, second.predictions, second.known, second.unscored) == (first.run, 0, 1, False)
    with beds.read() as connection:
        assert latest_run(connection).id == model
        row = list_images(connection, ImageFilter(), limit=1).rows[0]
        assert (row.image.id, row.predicted) == (1, 1)
        assert [each.run for each in load_contents(connection, 1).predictions] == [model]
    import_paths(beds, [bens], as_="predictions")
    with beds.read() as connection:
        assert latest_run(connection).id == first.run
        assert load_latest_run(connection, 1).id == first.run


def test_a_version_that_was_the_only_run_leaves_images_without_one(beds, bens):
    import_paths(beds, [bens], as_="predictions")
    import_paths(beds, [bens], as_="second")
    with beds.read() as connection:
        assert load_latest_run(connection, 1) is None
        assert list_images(connection, ImageFilter(), limit=1).rows[0].predicted == 0


def test_whether_a_second_annotator_placed_a_mark_is_kept(beds, write_coco, square):
    file = write_coco([{"segmentation": square, "circle": [20, 20, 10]}, {"segmentation": TRIANGLE}])
    run = import_paths(beds, [file], as_="second").run
    with beds.read() as connection:
        marked, drawn = predictions_by(connection, run, 1)
    assert (marked.whole, marked.extra) == (Circle(20, 20, 10), {"marked": True})
    assert (drawn.whole, drawn.extra) == (None, {})
