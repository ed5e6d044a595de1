"""Missing whole outlines, worked out image by image."""

from __future__ import annotations

import pytest

from fairyring.app.caps.filling_in import fill_in
from fairyring.model.geometry.shapes import Circle
from fairyring.storage.contents import load_annotations, load_contents
from fairyring.storage.derived import images_with_underived
from fairyring.storage.images import get_image
from fairyring.storage.journal import Derived, commit
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.project import Project
from tests.support.tab import new_cap
from tests.unit.app.conftest import circle


def test_filling_in_finds_what_is_missing_and_then_nothing_more(project: Project) -> None:
    commit(project, [Derived(edit=new_cap(2, mark=Circle(30, 30, 9)))], user="Ada")
    seen: list[tuple[int, int, str]] = []
    assert fill_in(project, progress=lambda *step: seen.append(step)) == 3
    assert [step[:2] for step in seen] == [(0, 2), (1, 2)]
    with project.read() as connection:
        assert images_with_underived(connection) == []
        marked = load_annotations(connection, 2)[0]
        left, right = load_contents(connection, 1).predictions
    assert marked.centre == (30, 30)
    assert left.centre == pytest.approx((40, 40), abs=0.25)
    assert right.centre == pytest.approx((110, 60), abs=0.25)
    assert fill_in(project) == 0


def test_filling_in_can_be_stopped_between_images(project: Project) -> None:
    commit(project, [Derived(edit=new_cap(2))], user="Ada")

    def stop(done: int, _total: int, _what: str) -> None:
        if done == 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fill_in(project, progress=stop)
    with project.read() as connection:
        assert images_with_underived(connection) == [2]


def statistics_of(project: Project, image: int) -> dict[str, float] | None:
    with project.read() as connection:
        return get_image(connection, image).statistics


def test_what_is_measured_on_a_run_is_kept_with_the_image_until_another_run(project: Project) -> None:
    assert statistics_of(project, 1) is None
    fill_in(project)
    measured = statistics_of(project, 1)
    assert measured is not None
    commit(project, [Derived(edit=new_cap(1, visible=circle(75, 80, 10, points=6)))], user="Ada")
    fill_in(project)
    assert statistics_of(project, 1) == measured

    def see_again(connection: object) -> None:
        run = add_run(connection, name="again", kind="simulated")
        coarse = [NewPrediction(visible=circle(60, 60, 30, points=7), score=0.9, uid="coarse")]
        add_predictions(connection, run_id=run.id, image_id=1, predictions=coarse)

    project.write(see_again)
    fill_in(project)
    assert statistics_of(project, 1) != measured


def test_labels_are_measured_where_no_run_has_been(project: Project) -> None:
    edits = [new_cap(2, uid=str(x), edit=str(x), visible=circle(x, 60, 25)) for x in (40, 100)]
    commit(project, [Derived(edit=edit) for edit in edits], user="Ada")
    fill_in(project)
    assert statistics_of(project, 2) is not None


def test_a_mark_alone_measures_nothing(project: Project) -> None:
    commit(project, [Derived(edit=new_cap(2, visible=[], mark=Circle(30, 30, 9)))], user="Ada")
    fill_in(project)
    assert statistics_of(project, 2) is None
