"""One server a project: it holds a lock on a file in the project's folder, and notes its address there."""

from __future__ import annotations

import fcntl
import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from fairyring.storage.errors import StoreError

log = logging.getLogger(__name__)

LOCK = ".served"


@contextmanager
def served(folder: Path, *, address: str) -> Iterator[None]:
    """Holds the lock for as long as the block runs, at most until this process ends.

    A read-only project is not locked, as its servers change nothing, nor one on a drive without locks.

    Raises:
        StoreError: another server has it.
    """
    try:
        lock = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT, 0o666)
    except OSError:
        yield
        return
    try:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise StoreError(_is_served(folder)) from None
        except OSError as error:
            log.warning(
                "%s cannot be locked (%s); see to it that one server opens it.", folder, error.strerror
            )
        os.ftruncate(lock, 0)
        os.write(lock, address.encode())
        yield
    finally:
        os.close(lock)


def require_not_served(folder: Path) -> None:
    """Raises StoreError where a server has the project open."""
    try:
        lock = os.open(folder / LOCK, os.O_RDONLY)
    except OSError:
        return
    try:
        fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        raise StoreError(_is_served(folder)) from None
    except OSError:
        return
    finally:
        os.close(lock)


def _is_served(folder: Path) -> str:
    try:
        address = (folder / LOCK).read_text(errors="replace")
    except OSError:
        address = ""
    at = f" at {address}" if address.isprintable() and address else ""
    return f"{folder} is served already{at}; work there, or end that server first."
