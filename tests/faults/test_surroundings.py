"""Around a server the disk fills, the database is locked, the clock goes back, and lines are cut."""

from __future__ import annotations

import resource
import socket
import sqlite3
import struct
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from datetime import UTC, datetime, timedelta, tzinfo
from pathlib import Path

import msgspec
import numpy as np
import PIL.Image
import pytest

from fairyring.app.bench.serving import Server, served
from fairyring.app.protocol import Edits, Notice, Outcomes
from fairyring.storage.db import clock
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import Derived, commit, history
from fairyring.storage.project import create_project, open_project
from fairyring.storage.records import Accepted, Edit
from tests.support.consistent import faults_of
from tests.support.how_much import by_form
from tests.support.kept import live_caps
from tests.support.tab import Tab, new_cap, until

LOCKED_S = by_form(short=2.0, usual=30.0, long=35.0)
"""The last is longer than the server waits for a lock."""
CUTS = by_form(short=10, usual=100, long=1000)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A project of one photo."""
    PIL.Image.fromarray(np.full((240, 320, 3), 90, np.uint8)).save(tmp_path / "bed_1.jpg")
    with create_project(tmp_path / "beds") as project:
        import_paths(project, [tmp_path / "bed_1.jpg"])
    return tmp_path / "beds"


def cap(number: int) -> Edit:
    return new_cap(1, uid=f"cap-{number}", edit=f"edit-{number}")


def said_or_stored(tab: Tab, *edits: Edit) -> Notice | Outcomes:
    """What the server answers to a change set: an error in a sentence, or what became of the edits."""
    tab.send(Edits(edits=list(edits)))
    return answer_of(tab)


def answer_of(tab: Tab) -> Notice | Outcomes:
    return tab.expect(
        Notice | Outcomes, lambda each: isinstance(each, Outcomes) or each.level == "error", within_s=60
    )


def store(tab: Tab, *edits: Edit) -> None:
    """Sends edits until they are stored, as a tab does."""

    def is_stored() -> bool:
        found = said_or_stored(tab, *edits)
        return isinstance(found, Outcomes) and all(isinstance(each, Accepted) for each in found.outcomes)

    until(is_stored, "the edits to be stored", within_s=60)


def assert_only(folder: Path, count: int) -> None:
    """These caps are stored, each once, and no other is."""
    acknowledged = {f"edit-{number}": f"cap-{number}" for number in range(count)}
    assert sorted(live_caps(folder)) == sorted(acknowledged.values())
    assert faults_of(folder / "project.db", acknowledged=acknowledged, sent=acknowledged) == []


@contextmanager
def full_disk(server: Server) -> Iterator[None]:
    """No file of the server's may grow."""
    assert server.process is not None
    before = resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE)
    resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (0, before[1]))
    try:
        yield
    finally:
        resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, before)


def test_on_a_full_disk_edits_are_refused_in_a_sentence_and_go_in_once_there_is_room(folder: Path) -> None:
    with served(folder) as server, Tab(server.port, image=1) as tab:
        store(tab, cap(0))
        with full_disk(server):
            for _ in range(3):
                found = said_or_stored(tab, cap(1))
                assert isinstance(found, Notice)
                assert "disk" in found.text
            assert live_caps(folder) == ["cap-0"]
        store(tab, cap(1))
    assert_only(folder, 2)


def test_an_edit_waits_for_a_program_that_has_locked_the_database(folder: Path) -> None:
    """Where that takes too long, it is said so, and the edit goes in when it is sent again."""
    with served(folder) as server, Tab(server.port, image=1) as tab:
        store(tab, cap(0))
        with closing(sqlite3.connect(folder / "project.db", isolation_level=None)) as other:
            other.execute("BEGIN IMMEDIATE")
            tab.send(Edits(edits=[cap(1)]))
            time.sleep(LOCKED_S)
            assert live_caps(folder) == ["cap-0"]
            other.execute("ROLLBACK")
        found = answer_of(tab)
        if isinstance(found, Notice):
            assert "locked" in found.text
            store(tab, cap(1))
    assert_only(folder, 2)


def test_a_clock_that_goes_back_changes_no_order(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Earlier(datetime):
        back = timedelta(0)

        @classmethod
        def now(cls, tz: tzinfo | None = None) -> datetime:
            return datetime.now(tz or UTC) - cls.back

    monkeypatch.setattr(clock, "datetime", Earlier)
    with open_project(folder) as project:
        for revision, back in enumerate((timedelta(0), timedelta(days=1), timedelta(days=400))):
            Earlier.back = back
            visible = [[revision + 10.0, 20.0, 60.0, 20.0, 60.0, 60.0]]
            edit = new_cap(1, uid="cap-0", edit=f"edit-{revision}", base=revision, visible=visible)
            (outcome,) = commit(project, [Derived(edit=edit)], user="Ada")
            assert isinstance(outcome, Accepted)
            assert outcome.annotation.revision == revision + 1
        with project.read() as connection:
            entries = history(connection, "cap-0")
    assert [entry.revision for entry in entries] == [1, 2, 3]
    assert sorted(entry.made_at for entry in entries) == [entry.made_at for entry in reversed(entries)]
    acknowledged = {f"edit-{revision}": "cap-0" for revision in range(3)}
    assert faults_of(folder / "project.db", acknowledged=acknowledged) == []


def test_a_line_that_is_cut_in_the_middle_of_a_message_stores_it_whole_or_not_at_all(folder: Path) -> None:
    """Wherever it is cut; sent again over another line, each edit is stored once."""
    chance = np.random.default_rng(1)
    with served(folder) as server:
        for number in range(CUTS):
            edits = [cap(2 * number), cap(2 * number + 1)]
            with Tab(server.port, name="Bo", image=1) as cut:
                frame = frame_of(Edits(edits=edits))
                cut.editor.socket.sendall(frame[: int(chance.integers(0, len(frame) + 1))])
                cut_off(cut.editor.socket)
            assert len(live_caps(folder)) in (2 * number, 2 * number + 2)
            with Tab(server.port, name="Bo", image=1) as again:
                store(again, *edits)
    assert_only(folder, 2 * CUTS)


def frame_of(message: Edits) -> bytes:
    """The bytes of a message on the line: one masked text frame."""
    text = msgspec.json.encode(message)
    return bytes([0x81, 0x80 | 126]) + struct.pack(">H", len(text)) + bytes(4) + text


def cut_off(line: socket.socket) -> None:
    """Ends a connection as a pulled plug does that is put in elsewhere: reset, without a word."""
    line.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    line.shutdown(socket.SHUT_RD)
    line.close()
