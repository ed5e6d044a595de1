"""A project that nobody may change, in the browser."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from fairyring.app.addresses import photo_address
from fairyring.storage.images import get_image
from fairyring.storage.project import Project, open_project
from fairyring.storage.records import Refused
from tests.support.tab import Tab, new_cap
from tests.support.unprivileged import make_read_only, nobody, open_folder, state_of

ADA = {"Cookie": "fairyring_name=Ada"}


@pytest.fixture
def project(made_once: Path) -> Iterator[Project]:
    """Opened by somebody who may only look at it."""
    with open_folder() as shared:
        folder = Path(shutil.copytree(made_once, shared / "beds"))
        make_read_only(folder)
        with nobody():
            opened = open_project(folder)
        with opened:
            yield opened


def test_photos_are_shown_and_edits_refused_and_nothing_changes(port: int, project: Project) -> None:
    before = state_of(project.folder)
    with project.read() as connection:
        address = photo_address(get_image(connection, 1))

    answer = httpx.get(f"http://127.0.0.1:{port}{address}?w=160", headers=ADA)
    with Tab(port, image=1) as tab:
        (outcome,) = tab.edit(new_cap(1)).outcomes

    assert answer.status_code == 200
    assert isinstance(outcome, Refused)
    assert "is read-only; make its folder and files writable" in outcome.reason
    assert state_of(project.folder) == before
