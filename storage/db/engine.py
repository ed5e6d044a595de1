"""Connections: how SQLite is set up so that what is acknowledged is on disk."""

from __future__ import annotations

import logging
import sqlite3
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unicodedata import normalize
from urllib.parse import quote

from sqlalchemy import URL, Engine, create_engine, event, exc
from sqlalchemy.engine import make_url
from sqlalchemy.pool import NullPool

from fairyring.storage.errors import StoreError

log = logging.getLogger(__name__)

BUSY_SECONDS = 30
"""How long a writer waits for another process (an import of tens of thousands of caps takes seconds)."""

READERS = 40
"""Readers at once whose connections are kept: to open one takes longer than what most of them read."""
READERS_CACHE_KIB = 512
"""What each of them keeps of the file: by SQLite's own 2 MB a server would grow with each it ever needed."""

NETWORK_FILE_SYSTEMS = {
    "nfs",
    "nfs4",
    "cifs",
    "smb3",
    "smbfs",
    "afpfs",
    "fuse.sshfs",
    "9p",
    "ceph",
    "glusterfs",
}


def connect_engine(url: str | URL, *, write: bool) -> Engine:
    """An engine for readers (a pool, one snapshot a transaction) or for the one writer.

    Raises:
        StoreError: the address is none, or the database's driver is not installed.
    """
    try:
        return _engine(url, write=write)
    except (exc.ArgumentError, ImportError) as error:
        raise StoreError(
            f"The database cannot be reached: {error}. Its address looks like "
            "postgresql+psycopg://HOST/NAME, and its driver (here psycopg) has to be installed."
        ) from error


def _engine(url: str | URL, *, write: bool) -> Engine:
    if make_url(url).get_backend_name() != "sqlite":
        return create_engine(url, **({"pool_size": 1, "max_overflow": 0} if write else {}))
    pool = {"pool_size": 1, "max_overflow": 0} if write else {"pool_size": READERS}
    engine = create_engine(url, connect_args={"timeout": BUSY_SECONDS, "check_same_thread": False}, **pool)
    event.listen(engine, "connect", _set_up_sqlite)
    if not write:
        event.listen(engine, "connect", _keep_little)
    begin = "BEGIN IMMEDIATE" if write else "BEGIN"
    event.listen(engine, "begin", lambda connection: connection.exec_driver_sql(begin))
    return engine


def connect_read_only(database: Path) -> Engine:
    """An engine for an SQLite file that must not be changed."""
    address = f"file:{quote(str(database.resolve()))}?mode=ro"
    return create_engine("sqlite://", creator=lambda: sqlite3.connect(address, uri=True), poolclass=NullPool)


def _set_up_sqlite(connection: Any, _record: Any) -> None:
    # SQLite's own knows upper and lower case of ASCII alone.
    connection.create_function("lower", 1, _folded, deterministic=True)
    connection.isolation_level = None  # the driver's own BEGIN would come too late: transactions begin above
    for pragma in (
        "journal_mode = WAL",
        "synchronous = FULL",
        "foreign_keys = ON",
        f"busy_timeout = {BUSY_SECONDS * 1000}",
        "trusted_schema = OFF",
        "cell_size_check = ON",
    ):
        connection.execute(f"PRAGMA {pragma}")


def _keep_little(connection: Any, _record: Any) -> None:
    connection.execute(f"PRAGMA cache_size = -{READERS_CACHE_KIB}")


def _folded(value: Any) -> Any:
    """Text as it is compared where case does not matter."""
    return normalize("NFC", value).casefold() if isinstance(value, str) else value


@contextmanager
def explained(what: str) -> Generator[None]:
    """Turns the database's own errors into a sentence about ``what``.

    Raises:
        StoreError: for a full disk, a lock held for too long, a damaged file or an unreachable server.
    """
    try:
        yield
    except exc.DBAPIError as error:
        reason = _reason(str(error.orig))
        if reason is None and not isinstance(error, exc.OperationalError):
            raise
        raise StoreError(f"{what}: {reason or f'the database says “{error.orig}”'}.") from error
    except sqlite3.Error as error:
        raise StoreError(f"{what}: {_reason(str(error)) or f'the database says “{error}”'}.") from error


def _reason(message: str) -> str | None:
    reasons = {
        "is full": "the disk is full, so nothing of this change was stored; free some space and try again",
        "is locked": f"another program has locked the database for {BUSY_SECONDS} s; close it and try again",
        "malformed": "the database is damaged; restore the latest backup",
        "not a database": "the file is not a Fairyring database or is damaged; restore the latest backup",
        "unable to open": "the database cannot be opened; check that the folder exists and may be written to",
        "readonly": "the database may not be written to; check the permissions of the folder and the file",
        "disk I/O error": "the disk could not be read or written; check it, and restore a backup if need be",
    }
    return next((text for part, text in reasons.items() if part in message), None)


def warn_of_network_drive(folder: Path, *, mounts: Path = Path("/proc/mounts")) -> None:
    """Logs a warning where locking cannot be relied on: SQLite's journal needs a local disk."""
    kind = _file_system(folder.resolve(), mounts)
    if kind in NETWORK_FILE_SYSTEMS:
        log.warning(
            "%s lies on a network drive (%s): SQLite may lose edits there when two machines write. "
            "Move the project to a local disk, or give it a PostgreSQL database.",
            folder,
            kind,
        )


def _file_system(folder: Path, mounts: Path) -> str | None:
    if not mounts.exists():
        return None
    kinds: dict[Path, str] = {}
    for line in mounts.read_text(errors="replace").splitlines():
        _device, where, kind, *_rest = line.split(" ")
        kinds[Path(where.replace("\\040", " "))] = kind
    return next((kinds[path] for path in (folder, *folder.parents) if path in kinds), None)
