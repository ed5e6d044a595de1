"""Images that were read before are handed out again only while they are current."""

from __future__ import annotations

from fairyring.app.live.read_ahead import RecentImages
from fairyring.model.geometry.shapes import Circle
from fairyring.storage.journal import Derived, commit
from fairyring.storage.project import Project
from fairyring.storage.statuses import set_status
from tests.support.tab import new_cap


def test_an_image_is_not_read_again_until_it_changes(project: Project) -> None:
    recent = RecentImages()
    with project.read() as connection:
        first_version, first = recent.load(connection, 1)
        assert recent.load(connection, 1)[1].predictions is first.predictions
    commit(project, [Derived(edit=new_cap(1, mark=Circle(1, 2, 3)))], user="Ada")
    with project.read() as connection:
        version, second = recent.load(connection, 1)
    assert version > first_version
    assert [annotation.uid for annotation in second.annotations] == ["cap-1"]


def test_a_new_status_shows_although_no_cap_has_changed(project: Project) -> None:
    recent = RecentImages()
    with project.read() as connection:
        recent.load(connection, 1)
    project.write(lambda connection: set_status(connection, 1, "approved", user="Ada"))
    with project.read() as connection:
        assert recent.load(connection, 1)[1].image.status == "approved"
