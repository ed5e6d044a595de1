"""A note in a demo's folder of what it was begun with, so that an interrupted one can be finished.

Light to import: whether there is anything left to make is asked each time the demo is opened.
"""

from __future__ import annotations

import fcntl
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

import msgspec
from msgspec import Struct

from fairyring.model.whole_files import written_whole
from fairyring.storage.errors import StoreError

UNFINISHED = "unfinished"
"""Folder in the project that exists while the demo is being made."""
BEGUN, LOCK = "begun.json", "lock"


class Begun(Struct, frozen=True, kw_only=True):
    """Which beds a demo shows."""

    count: int
    seed: int


def begun_in(folder: Path) -> Begun | None:
    """The demo that was begun in ``folder`` and never finished. Raises StoreError for a damaged note."""
    note = folder / UNFINISHED / BEGUN
    if not note.is_file():
        return None
    try:
        return msgspec.json.decode(note.read_bytes(), type=Begun)
    except (OSError, msgspec.DecodeError) as error:
        raise StoreError(f"{note} cannot be read ({error}); delete {folder} to start afresh.") from error


def beds_of(folder: Path) -> Path:
    """The folder that the beds are rendered into."""
    return folder / UNFINISHED / "beds"


@contextmanager
def begun(folder: Path, demo: Begun) -> Iterator[Begun]:
    """Yields the demo begun in ``folder``, or begins this one; after the block it counts as finished.

    Raises StoreError where another process is making it, or ``folder`` cannot be written.
    """
    note = folder / UNFINISHED / BEGUN
    with _locked(note.with_name(LOCK), folder):
        found = begun_in(folder)
        if found is None:
            with written_whole(note) as fresh:
                fresh.write_bytes(msgspec.json.encode(demo))
        yield found or demo
        # The note first: what is left over without it is no demo to go on with.
        note.unlink()
        shutil.rmtree(folder / UNFINISHED)


def _locked(lock: Path, folder: Path) -> IO[str]:
    """Takes the lock; it is released when the file is closed or this process ends."""
    try:
        lock.parent.mkdir(parents=True, exist_ok=True)
        opened = lock.open("w")
        fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise StoreError(f"{folder} is being made by another process; wait for it, or end it.") from None
    except OSError as error:
        raise StoreError(f"{folder} cannot be made a project: {error.strerror}.") from error
    return opened
