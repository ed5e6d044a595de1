"""The reviewer's figures, worked out by hand on two marked caps in a photo of 160 × 120."""

from __future__ import annotations

import json
import math

import pytest

from fairyring.app.review.figures import figures_of, review_of, worst_caps
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.shapes import Circle, fit_of_shape
from fairyring.storage.journal import Derived, commit
from fairyring.storage.predictions import NewPrediction, add_predictions, latest_run
from fairyring.storage.project import Project
from fairyring.storage.statuses import set_status
from tests.support.tab import new_cap
from tests.support.two_marked import mark_both
from tests.unit.app.conftest import circle

CDR_OF_LEFT = 100 * (1.6 / 160 + 0.6 / 120)


def mark_far(project: Project, *, sd: float, **fields: bool) -> None:
    """Ben marks a third cap, predicted a pixel to the right of it; the mark is off by ``sd``."""

    def predict(connection: object) -> None:
        run = latest_run(connection)
        assert run is not None
        fit = fit_of_shape(Circle(131, 20, 12))
        said = NewPrediction(visible=circle(131, 20, 12), score=0.7, uid="up", fit=fit)
        add_predictions(connection, run_id=run.id, image_id=1, predictions=[said])

    project.write(predict)
    made = new_cap(1, uid="up", edit="up", visible=circle(130, 20, 12), mark=Circle(130, 20, 12), **fields)
    fit = fit_of_shape(Circle(130, 20, 12), centre_sd=(sd, sd))
    commit(project, [Derived(edit=made, fit=fit)], user="Ben")


def test_the_figures_are_those_of_equation_10_with_what_was_missed_apart(project: Project) -> None:
    mark_both(project)
    figures = figures_of(review_of(project))
    assert figures["cdr"]["mean"] == pytest.approx(CDR_OF_LEFT / 2)
    assert figures["px"]["mean"] == pytest.approx(math.hypot(1.6, 0.6) / 2)
    assert (figures["matched"], figures["missed"], figures["extra"], figures["marked"]) == (2, 1, 0, 2)
    assert figures["groups"]["annotator"]["Ada"]["matched"] == 2
    json.dumps(figures)


def test_the_floor_is_what_the_marks_are_off_by(project: Project) -> None:
    mark_both(project)  # by circles of 20 px, whose centres are off by .04 of that
    of_one = 100 * math.sqrt(2 / math.pi) * 0.8 * (1 / 160 + 1 / 120)
    figures = figures_of(review_of(project))
    assert figures["floor"] == {"cdr_mean": pytest.approx(of_one), "count": 2}


def test_an_image_that_nobody_has_worked_on_does_not_count(project: Project) -> None:
    mark_both(project)
    review = review_of(project)
    assert [image.file_name for image in review.images] == ["bed_1.jpg"]
    assert review.untouched[0] == "bed_2.jpg"
    assert len(review.untouched) == 2
    project.write(lambda connection: set_status(connection, 2, "approved", user="Ada"))
    assert len(review_of(project).untouched) == 1


def test_predictions_count_as_extra_only_where_somebody_looked(project: Project) -> None:
    assert figures_of(review_of(project))["extra"] == 0
    project.write(lambda connection: set_status(connection, 1, "annotated", user="Ada"))
    assert figures_of(review_of(project))["extra"] == 2


def test_marks_that_hardly_tell_a_centre_are_counted_and_left_out_when_asked(project: Project) -> None:
    mark_both(project)
    mark_far(project, sd=1.5)  # more than 5 % of 24 px
    with_it, without = figures_of(review_of(project)), figures_of(review_of(project, only_sure=True))
    assert (with_it["unsure_marks"], with_it["matched"], with_it["left_out"]) == (1, 3, 0)
    assert (without["unsure_marks"], without["matched"], without["left_out"]) == (0, 2, 1)
    assert sorted(with_it["groups"]["annotator"]) == ["Ada", "Ben"]


def test_doubtful_caps_are_left_out_when_asked(project: Project) -> None:
    mark_both(project)
    mark_far(project, sd=0.1, doubtful=True)
    assert figures_of(review_of(project))["doubtful"] == 1
    assert figures_of(review_of(project, only_sure=True))["left_out"] == 1


def test_the_worst_caps_are_those_furthest_above_their_floor(project: Project) -> None:
    mark_both(project)
    mark_far(project, sd=0.1)  # a pixel off: .625 %, where the left one has 1.5 % and a floor of .93 %
    assert [cap.measured.row.truth for cap in worst_caps(review_of(project).caps)] == ["left", "up", "right"]
    floors = {cap.measured.row.truth: cap.floor for cap in review_of(project).caps}
    assert floors["up"] == pytest.approx(100 * math.sqrt(2 / math.pi) * 0.1 * (1 / 160 + 1 / 120))


def test_a_review_can_be_ended_between_images(project: Project) -> None:
    mark_both(project)

    def stop(*_: object) -> None:
        raise FairyringError("stopped")

    with pytest.raises(FairyringError, match="stopped"):
        review_of(project, progress=stop)
