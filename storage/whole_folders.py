"""Folders that are there whole or not at all. What a killed process leaves behind is cleared by the next one.

A folder in the making lies beside its place under a temporary name, and the process that makes it holds a
lock on it. The system lets go of that lock with the process, however it ends: what is locked is alive.
"""

from __future__ import annotations

import fcntl
import os
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from uuid import uuid4

from fairyring.storage.errors import StoreError

TEMPORARY = re.compile(r"\.fairyring-[0-9a-f]{32}")


@contextmanager
def made_whole(target: Path) -> Iterator[Path]:
    """Yields a new folder beside ``target``, which may be an empty one; after the block it takes that name.

    Whatever the block raises leaves nothing behind.

    Raises:
        StoreError: ``target`` holds something or cannot be written.
    """
    if target.exists() and (not target.is_dir() or any(target.iterdir())):
        raise StoreError(f"{target} is not empty; name a new or an empty folder.")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        clear_leftovers(target.parent)
        with temporary_folder(target.parent) as folder:
            yield folder
            folder.replace(target)
            sync(target.parent)
    except OSError as error:
        raise StoreError(f"{target} cannot be written: {error.strerror}.") from error


@contextmanager
def temporary_folder(parent: Path) -> Iterator[Path]:
    """Yields a new folder in ``parent`` that is gone after the block, unless it was given another name.

    Raises OSError.
    """
    folder, lock = _locked_folder(parent)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        os.close(lock)


def leftovers_in(parent: Path) -> Iterator[Path]:
    """Yields the temporary folders in ``parent`` that nobody makes any more; each is gone after its turn."""
    for folder in sorted(parent.iterdir()) if parent.is_dir() else ():
        if not TEMPORARY.fullmatch(folder.name) or folder.is_symlink():
            continue
        try:
            lock = _lock(folder)
        except OSError:
            continue  # somebody is making it, or this drive knows no locks
        yield folder
        shutil.rmtree(folder, ignore_errors=True)
        os.close(lock)


def clear_leftovers(parent: Path) -> None:
    """Removes the temporary folders in ``parent`` that nobody is making any more."""
    for _ in leftovers_in(parent):
        pass


def sync(path: Path) -> None:
    """Waits until a file or the names in a folder are on the disk. Raises OSError."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _locked_folder(parent: Path) -> tuple[Path, int]:
    while True:
        folder = parent / f".fairyring-{uuid4().hex}"
        folder.mkdir()
        try:
            lock = os.open(folder, os.O_RDONLY)
        except FileNotFoundError:
            continue  # not locked for a moment, it was cleared away
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(lock)  # it is being cleared away
            continue
        except OSError:
            return folder, lock  # where no locks are known, nobody clears anything away
        if folder.exists():
            return folder, lock
        os.close(lock)


def _lock(folder: Path) -> int:
    lock = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(lock)
        raise
    return lock
