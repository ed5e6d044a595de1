"""Projects that may be looked at and not changed."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from fairyring.storage.backup import back_up, restore
from fairyring.storage.contents import load_annotations
from fairyring.storage.errors import StoreError
from fairyring.storage.exporting import export_coco
from fairyring.storage.images import ImageFilter, list_images
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import commit
from fairyring.storage.project import Project, open_project
from fairyring.storage.records import Cap, Refused
from fairyring.storage.statuses import set_status
from tests.support.edits import edit
from tests.support.exported import SQUARE, store
from tests.support.unprivileged import make_read_only, make_writable, nobody, open_folder, state_of


@pytest.fixture
def folder(project_of_three: Path) -> Iterator[Path]:
    """A project of three photos with one cap, in a folder that others reach."""
    with open_folder() as shared:
        with open_project(shutil.copytree(project_of_three, shared / "beds")) as opened:
            store(opened, Cap(visible=[SQUARE]))
        yield shared / "beds"


@pytest.fixture
def read_only(folder: Path) -> Iterator[Project]:
    make_read_only(folder)
    with nobody(), open_project(folder) as opened:
        yield opened


def test_it_can_be_looked_at_and_nothing_in_it_changes(folder: Path) -> None:
    make_read_only(folder)
    before = state_of(folder)
    with nobody(), open_project(folder) as opened:
        assert opened.read_only
        with opened.read() as connection:
            assert list_images(connection, ImageFilter()).total == 3
            assert [a.cap.visible for a in load_annotations(connection, 1)] == [[SQUARE]]
        opened.cache.mkdir()
        cache = opened.cache
    assert not cache.exists()
    assert state_of(folder) == before


def test_it_can_be_exported_and_backed_up(read_only: Project, folder: Path) -> None:
    assert export_coco(read_only, folder.parent / "coco").annotations == 1

    back_up(read_only, folder.parent / "backup")
    restore(folder.parent / "backup", folder.parent / "again")
    with open_project(folder.parent / "again") as again, again.read() as connection:
        assert not again.read_only
        assert [a.cap.visible for a in load_annotations(connection, 1)] == [[SQUARE]]


def test_whatever_would_change_it_is_refused_in_a_sentence(read_only: Project, folder: Path) -> None:
    (outcome,) = commit(read_only, [edit(cap=Cap(visible=[SQUARE]))], user="ann")
    assert isinstance(outcome, Refused)
    assert "is read-only" in outcome.reason
    with pytest.raises(StoreError, match="is read-only; make its folder and files writable"):
        read_only.write(lambda connection: set_status(connection, 1, "approved", user="ann"))
    with pytest.raises(StoreError, match="is read-only"):
        import_paths(read_only, [folder])


@pytest.mark.parametrize("lost", ["", "-shm"], ids=["all of it", "a copy without the shared file"])
def test_what_stands_in_the_log_alone_is_seen(folder: Path, lost: str) -> None:
    """As after a server that was killed: its last edits are not in project.db itself."""
    copy = folder.parent / "copy"
    with open_project(folder) as served:
        store(served, Cap(visible=[SQUARE]), image=2)
        shutil.copytree(folder, copy)
    assert (copy / "project.db-wal").stat().st_size > 0
    if lost:
        (copy / f"project.db{lost}").unlink()
    make_read_only(copy)
    before = state_of(copy)

    with nobody(), open_project(copy) as opened, opened.read() as connection:
        assert len(load_annotations(connection, 2)) == 1
    assert state_of(copy) == before


def test_it_is_seen_as_it_was_when_it_was_opened(folder: Path) -> None:
    make_read_only(folder)
    with nobody():
        opened = open_project(folder)
    make_writable(folder)
    with open_project(folder) as writing:
        store(writing, Cap(visible=[SQUARE]), image=2)

    with opened, opened.read() as connection:
        assert len(load_annotations(connection, 1)) == 1
        assert load_annotations(connection, 2) == []
    with open_project(folder) as again, again.read() as connection:
        assert len(load_annotations(connection, 2)) == 1
