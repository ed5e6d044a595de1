"""Open tabs, while another process writes to the project."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from fairyring.app.protocol import Changed, Predicted, Show
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import Derived, commit
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.project import Project, create_project, open_project
from fairyring.storage.records import Accepted, Edit
from tests.support.tab import SQUARE, Tab, new_cap
from tests.unit.app.conftest import circle, served


@pytest.fixture
def elsewhere(project: Project) -> Iterator[Project]:
    """The same project, as another process has it open."""
    with open_project(project.folder) as other:
        yield other


def store(project: Project, edit: Edit) -> None:
    (outcome,) = commit(project, [Derived(edit=edit)], user="Script")
    assert isinstance(outcome, Accepted), outcome


def test_a_cap_made_changed_and_deleted_elsewhere_is_shown(port: int, elsewhere: Project) -> None:
    with Tab(port) as tab:
        tab.expect(Show)
        store(elsewhere, new_cap(1, uid="theirs", edit="made"))
        (made,) = tab.expect(Changed).annotations
        assert (made.uid, made.revision, made.cap.visible) == ("theirs", 1, SQUARE)
        store(elsewhere, new_cap(1, uid="theirs", edit="moved", base=1, visible=circle(60, 60, 20)))
        (moved,) = tab.expect(Changed).annotations
        assert moved.revision == 2
        store(elsewhere, Edit(id="gone", annotation="theirs", image=1, base=2, cap=None))
        (gone,) = tab.expect(Changed).annotations
        assert gone.deleted
        assert gone.revision == 3


def test_predictions_made_elsewhere_are_shown(port: int, elsewhere: Project) -> None:
    with Tab(port) as tab:
        assert len(tab.expect(Show).contents.predictions) == 2

        def predict(connection: object) -> None:
            run = add_run(connection, name="later", kind="network")
            seen = [NewPrediction(visible=circle(80, 60, 20), score=0.7, uid="one")]
            add_predictions(connection, run_id=run.id, image_id=1, predictions=seen)

        elsewhere.write(predict)
        assert [p.score for p in tab.expect(Predicted).predictions] == [0.7]


def test_ones_own_edits_are_not_told_back_as_somebody_elses(port: int) -> None:
    with Tab(port) as tab:
        tab.expect(Show)
        tab.edit(new_cap(1, uid="mine"))
        assert tab.nothing_more(Changed, within_s=2.5)


def test_what_two_tabs_know_already_is_not_told_again(port: int, elsewhere: Project) -> None:
    with Tab(port, name="Ada") as ada, Tab(port, name="Bob") as bob:
        ada.expect(Show)
        bob.expect(Show)
        ada.edit(new_cap(1, uid="mine"))
        assert bob.expect(Changed).user == "Ada"
        store(elsewhere, new_cap(2, uid="on another image", edit="other"))
        assert bob.nothing_more(Changed, within_s=2.5)
        assert ada.nothing_more(Changed, within_s=0.1)


def test_the_first_images_of_an_empty_project_are_shown_when_they_come(
    tmp_path: Path, made_once: Path
) -> None:
    with create_project(tmp_path / "empty") as empty, served(empty) as port, Tab(port) as tab:
        with open_project(tmp_path / "empty") as other:
            import_paths(other, [made_once / "images"])
        assert tab.expect(Show).contents.image.file_name == "bed_1.jpg"
