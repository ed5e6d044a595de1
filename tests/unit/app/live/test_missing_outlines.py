"""Whole outlines that an import left to be found, in a served project."""

from __future__ import annotations

from collections.abc import Callable

from fairyring.app.protocol import Changed, Show
from fairyring.storage.contents import load_annotations
from fairyring.storage.derived import images_with_underived
from fairyring.storage.journal import Derived, commit
from fairyring.storage.project import Project, open_project
from tests.support.tab import Tab, new_cap, until
from tests.unit.app.conftest import circle


def draw(project: Project, image: int, uid: str) -> None:
    """Stores a cap whose whole outline nobody has worked out."""
    commit(project, [Derived(edit=new_cap(image, uid=uid, edit=uid, visible=circle(60, 60, 20)))], user="x")


def lacking(project: Project) -> list[int]:
    with project.read() as connection:
        return images_with_underived(connection)


def test_an_image_that_is_opened_has_them_all(serve: Callable[..., int], project: Project) -> None:
    draw(project, 1, "a")
    with Tab(serve()) as tab:
        shown = tab.expect(Show).contents
        assert all(cap.centre is not None for cap in (*shown.annotations, *shown.predictions))
        assert shown.image.statistics is not None


def test_a_server_finds_those_of_all_images_without_being_asked(
    serve: Callable[..., int], project: Project
) -> None:
    for image in (2, 3):
        draw(project, image, f"of {image}")
    assert lacking(project) == [1, 2, 3]
    serve()
    until(lambda: lacking(project) == [], "the whole outlines")
    with project.read() as connection:
        (cap,) = load_annotations(connection, 3)
    assert cap.centre is not None


def test_what_another_process_brings_is_shown_with_them(port: int, project: Project) -> None:
    with Tab(port) as tab, open_project(project.folder) as elsewhere:
        tab.expect(Show)
        draw(elsewhere, 1, "theirs")
        (shown,) = tab.expect(Changed).annotations
        assert shown.centre is not None
        draw(elsewhere, 3, "out of sight")
        until(lambda: lacking(project) == [], "the whole outlines")
