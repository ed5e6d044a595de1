"""A server that is killed while three people edit, again and again: nothing acknowledged is lost."""

from __future__ import annotations

import logging
import os
import random
import shutil
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import PIL.Image
import pytest

from fairyring.app.bench.serving import Server
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import create_project
from tests.support.consistent import faults_of
from tests.support.how_much import by_form
from tests.support.person import Person
from tests.support.tab import until

KILLS = by_form(short=3, usual=200, long=1000)
COPIES = by_form(short=10, usual=200, long=2000)
log = logging.getLogger(__name__)
NAMES = ("Ada", "Bo", "Cy")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A project of one photo."""
    PIL.Image.fromarray(np.full((240, 320, 3), 90, np.uint8)).save(tmp_path / "bed_1.jpg")
    with create_project(tmp_path / "beds") as project:
        import_paths(project, [tmp_path / "bed_1.jpg"])
    return tmp_path / "beds"


@contextmanager
def at_work(server: Server) -> Iterator[list[Person]]:
    """Three people with a tab each; at the end all they sent is acknowledged."""
    people = [Person(server.port, name=name, image=1, seed=seed) for seed, name in enumerate(NAMES)]
    for person in people:
        person.start()
    yield people
    for person in people:
        person.stop()


def acknowledged_of(people: list[Person]) -> dict[str, str]:
    """The annotation of each edit that was acknowledged so far."""
    return {edit: found.uid for person in people for edit, found in dict(person.acknowledged).items()}


def assert_all_is_there(folder: Path, people: list[Person]) -> None:
    sent = {edit for person in people for edit in person.sent}
    assert [reason for person in people for reason in person.refused] == []
    assert faults_of(folder / "project.db", acknowledged=acknowledged_of(people), sent=sent) == []


@pytest.mark.timeout(60 + 60 * KILLS)
def test_no_acknowledged_edit_is_lost_or_stored_twice(folder: Path) -> None:
    chance = random.Random(1)
    server = Server(folder)
    server.start()
    with at_work(server) as people:
        for _ in range(KILLS):
            before = [len(person.acknowledged) for person in people]

            def all_saved(before: list[int] = before) -> bool:
                return all(len(p.acknowledged) > count for p, count in zip(people, before, strict=True))

            until(all_saved, "an edit of everybody", within_s=60)
            time.sleep(chance.uniform(0, 0.3))
            server.kill()
            server.start()
    server.stop()
    edits = sum(len(person.acknowledged) for person in people)
    log.info("%d kills, %d edits acknowledged", KILLS, edits)
    assert_all_is_there(folder, people)


@pytest.mark.timeout(120 + 5 * COPIES)
def test_copies_taken_at_any_moment_hold_what_was_acknowledged_by_then(folder: Path, tmp_path: Path) -> None:
    """The server is stopped for the moment, as a power cut or a snapshot of the disk would find it."""
    chance = random.Random(2)
    server = Server(folder)
    server.start()
    assert server.process is not None
    with at_work(server) as people:
        until(lambda: all(person.acknowledged for person in people), "everybody to begin", within_s=60)
        for number in range(COPIES):
            time.sleep(chance.uniform(0, 0.1))
            os.kill(server.process.pid, signal.SIGSTOP)
            acknowledged = acknowledged_of(people)
            copy = tmp_path / f"copy {number}"
            copy.mkdir()
            for file in folder.glob("project.db*"):
                shutil.copyfile(file, copy / file.name)
            os.kill(server.process.pid, signal.SIGCONT)
            assert faults_of(copy / "project.db", acknowledged=acknowledged) == []
            shutil.rmtree(copy)
    server.stop()
    assert_all_is_there(folder, people)
