"""Missing whole outlines, worked out image by image."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from fairyring.app.bench.projects import Bed, make_project
from fairyring.app.caps.filling_in import WORTH_PROCESSES, fill_in
from fairyring.app.caps.fitting import fitted_anew
from fairyring.model.geometry.shapes import Circle
from fairyring.storage.contents import load_annotations, load_contents
from fairyring.storage.derived import images_with_underived
from fairyring.storage.images import get_image
from fairyring.storage.journal import Derived, commit
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.project import Project, open_project
from fairyring.storage.runs import predictions_by
from tests.support.tab import new_cap
from tests.support.unprivileged import make_read_only, nobody, open_folder, state_of
from tests.unit.app.conftest import circle


def test_filling_in_finds_what_is_missing_and_then_nothing_more(project: Project) -> None:
    commit(project, [Derived(edit=new_cap(2, mark=Circle(30, 30, 9)))], user="Ada")
    seen: list[tuple[int, int, str]] = []
    assert fill_in(project, progress=lambda *step: seen.append(step)) == 3
    assert [step[:2] for step in seen] == [(0, 2), (1, 2), (2, 2)]
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


def test_what_an_older_run_said_is_found_by_itself(project: Project) -> None:
    """The image keeps what was measured on the latest run."""

    def see_again(connection: object) -> None:
        run = add_run(connection, name="again", kind="simulated")
        coarse = [NewPrediction(visible=circle(60, 60, 30, points=7), score=0.9, uid="coarse")]
        add_predictions(connection, run_id=run.id, image_id=1, predictions=coarse)

    project.write(see_again)
    fill_in(project)
    with project.read() as connection:
        of_runs = {run: predictions_by(connection, run, 1) for run in (1, 2)}
        latest = get_image(connection, 1)
    assert [cap.centre is not None for cap in (*of_runs[1], *of_runs[2])] == [True] * 3
    _, measured = fitted_anew(latest, [cap.visible for cap in of_runs[2]])
    assert latest.statistics == measured


def test_a_read_only_project_has_them_as_long_as_it_is_open(project: Project) -> None:
    with open_folder() as shared:
        folder = Path(shutil.copytree(project.folder, shared / "beds"))
        make_read_only(folder)
        before = state_of(folder)
        with nobody(), open_project(folder) as opened:
            assert fill_in(opened) == 2
            with opened.read() as connection:
                assert all(cap.centre for cap in load_contents(connection, 1).predictions)
        assert state_of(folder) == before


def test_many_images_are_filled_in_by_several_processes(tmp_path: Path) -> None:
    """What they find is, to the last digit, what one finds."""
    beds = [Bed(name=f"{i}.jpg", width=160, height=120, caps=6, vertices=16) for i in range(WORTH_PROCESSES)]
    found = []
    for name, compute in (("several", None), ("one", map)):
        (tmp_path / name).mkdir()
        with make_project(tmp_path / name, beds) as made:
            assert fill_in(made, compute=compute) == 6 * len(beds)
            with made.read() as connection:
                images = range(1, len(beds) + 1)
                found.append([[cap.whole for cap in load_annotations(connection, i)] for i in images])
    assert found[0] == found[1]
