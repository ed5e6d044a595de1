"""A process that stores edits, and that SIGKILL ends while it is at it."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Sequence
from multiprocessing.connection import Connection
from pathlib import Path

from fairyring.storage.journal import Derived, commit
from fairyring.storage.project import open_project
from fairyring.storage.records import Outcome, StatusEdit

# A process that has imported the product already is copied at each start: the next one is there at once.
_context = multiprocessing.get_context("forkserver")
_context.set_forkserver_preload(["tests.support.dying_store"])


class DyingStore:
    """A project that a process of its own writes to. Use it in a ``with``."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._start()

    def __enter__(self) -> DyingStore:
        return self

    def __exit__(self, *_: object) -> None:
        self._end()

    def commit(self, edits: Sequence[Derived], *, statuses: Sequence[StatusEdit], user: str) -> list[Outcome]:
        """Has a change set stored, and waits for the answer."""
        self._line.send((edits, statuses, user))
        return self._line.recv()

    def die_storing(
        self, edits: Sequence[Derived], *, statuses: Sequence[StatusEdit], user: str, after_s: float
    ) -> None:
        """Has a change set stored, and kills the process so many seconds later; another one takes over."""
        self._line.send((edits, statuses, user))
        time.sleep(after_s)
        self.die()

    def die(self) -> None:
        """Kills the process while nothing is asked of it; another one takes over."""
        self._end()
        self._start()

    def _start(self) -> None:
        self._line, theirs = _context.Pipe()
        self._process = _context.Process(target=_serve, args=(theirs, self._folder), daemon=True)
        self._process.start()
        theirs.close()
        assert self._line.recv() == "open"

    def _end(self) -> None:
        self._process.kill()
        self._process.join()
        self._line.close()


def _serve(line: Connection, folder: Path) -> None:
    with open_project(folder) as project:
        line.send("open")
        while True:
            edits, statuses, user = line.recv()
            line.send(commit(project, edits, statuses=statuses, user=user))
