"""Images that leave the project by a click, and come back, while others look at them."""

from __future__ import annotations

from fairyring.app.protocol import Notice, Show
from fairyring.storage.images import ImageFilter, list_ids
from fairyring.storage.project import Project, open_project
from fairyring.storage.taken_out import take_out
from tests.support.tab import Tab, new_cap

TAKE_OUT = "Take this image out"


def ids_in(project: Project) -> list[int]:
    with project.read() as connection:
        return list_ids(connection, ImageFilter())


def test_an_image_that_is_taken_out_leaves_every_tab_that_shows_it(port: int, project: Project) -> None:
    with Tab(port, name="Ada", image=1) as ada, Tab(port, name="Bo", image=1) as bo:
        ada.expect(Show)
        bo.expect(Show)
        ada.edit(new_cap(1))
        ada.panel.set(TAKE_OUT, True)
        for tab in (ada, bo):
            assert tab.expect(Show).contents.image.id == 2
    assert ids_in(project) == [2, 3]


def test_it_comes_back_with_its_caps(port: int, project: Project) -> None:
    with Tab(port, image=1) as tab:
        tab.expect(Show)
        tab.edit(new_cap(1))
        tab.panel.set(TAKE_OUT, True)
        tab.expect(Show, lambda shown: shown.contents.image.id == 2)
        tab.panel.set("Put back", True)
        back = tab.expect(Show, lambda shown: shown.contents.image.id == 1)
        assert [annotation.uid for annotation in back.contents.annotations] == [new_cap(1).annotation]
    assert ids_in(project) == [1, 2, 3]


def test_what_a_command_takes_out_leaves_the_tabs_too(port: int, project: Project) -> None:
    with Tab(port, image=2) as tab, open_project(project.folder) as elsewhere:
        tab.expect(Show)
        take_out(elsewhere, [2], user="Script")
        assert "bed_2.jpg was taken out of the project." in tab.expect(Notice).text
        assert tab.expect(Show).contents.image.id == 1
