"""Runs have names of their own, and are found by them."""

from __future__ import annotations

from typing import Any

import pytest

from fairyring.model.geometry.shapes import Circle, fit_of_shape
from fairyring.storage.errors import StoreError
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.project import Project
from fairyring.storage.runs import (
    images_seen_by,
    latest_runs_of,
    list_runs,
    predictions_by,
    rename_run,
    require_run,
)
from tests.unit.storage.conftest import SQUARE


def predict(project: Project, name: str, **caps: int) -> int:
    """A run that sees so many caps in each image; returns its number."""

    def work(connection: Any) -> int:
        run = add_run(connection, name=name, kind="network")
        for image, count in caps.items():
            new = [NewPrediction(visible=SQUARE, score=0.5, fit=fit_of_shape(Circle(20, 20, 14)))] * count
            add_predictions(connection, run_id=run.id, image_id=int(image[1:]), predictions=new)
        return run.id

    return project.write(work)


def test_the_list_says_what_each_run_saw_and_of_how_many_images_it_is_the_latest(beds: Project) -> None:
    predict(beds, "first", _1=2, _2=1, _3=0)
    predict(beds, "second", _2=3)
    with beds.read() as connection:
        rows = list_runs(connection)
        assert [(row.run.name, row.images, row.predictions, row.latest_of) for row in rows] == [
            ("first", 2, 3, 2),
            ("second", 1, 3, 1),
        ]
        assert [image.file_name for image in images_seen_by(connection, 1)] == [
            "bed_1.png",
            "bed_2.png",
            "bed_10.png",
        ]
        assert len(predictions_by(connection, 1, 2)) == 1
        latest = latest_runs_of(connection, [1, 2])
        assert [(run.name, count) for run, count in latest] == [("first", 1), ("second", 1)]


def test_no_two_runs_have_one_name(beds: Project) -> None:
    for _ in range(3):
        predict(beds, "lite0")
    predict(beds, "lite0 (4)")
    predict(beds, "lite0")
    with beds.read() as connection:
        names = [row.run.name for row in list_runs(connection)]
    assert names == ["lite0", "lite0 (2)", "lite0 (3)", "lite0 (4)", "lite0 (5)"]


def test_a_run_is_found_by_its_name_before_its_number(beds: Project) -> None:
    first, second = predict(beds, "2"), predict(beds, "other")
    with beds.read() as connection:
        assert require_run(connection, "2").id == first
        assert require_run(connection, "other").id == second
        assert require_run(connection, str(first)).id == first
        for nobody in ("3", "another", "99999999999999999999", "²"):
            with pytest.raises(StoreError, match="There is no run called"):
                require_run(connection, nobody)


def test_a_run_gets_another_name_unless_that_is_taken_or_none(beds: Project) -> None:
    first = predict(beds, "one")
    predict(beds, "two")
    beds.write(lambda c: rename_run(c, first, "before the lamps"))
    with beds.read() as connection:
        assert require_run(connection, "before the lamps").id == first
    for name in ("two", "", "a\nb"):
        with pytest.raises(StoreError):
            beds.write(lambda c, name=name: rename_run(c, first, name))
