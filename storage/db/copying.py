"""Copies of SQLite databases: taken while others write, and read back before anybody relies on them."""

from __future__ import annotations

import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from urllib.parse import quote

from fairyring.storage.db.engine import explained
from fairyring.storage.errors import StoreError

TRIES = 3


def copy_database(database: Path, copy: Path, *, named: Path) -> dict[str, int]:
    """Writes the database as it is now into the new file ``copy``; returns how many rows each table has.

    Errors call it ``named``.

    Raises:
        StoreError: the database is damaged, or ``copy`` cannot be written.
    """
    with explained(str(named)), _reading(database) as source:
        source.execute("BEGIN")
        counts = _counts(source)
        with explained(f"The copy of {named}"), closing(sqlite3.connect(copy)) as target:
            # Within the transaction above, so that what was counted is what is copied.
            source.backup(target)
            # One file, without a log beside it.
            target.execute("PRAGMA journal_mode = DELETE")
    if check_database(copy, named=named) != counts:
        raise StoreError(f"The copy of {named} does not hold the same; check the disk it was written to.")
    return counts


def check_database(database: Path, *, named: Path) -> dict[str, int]:
    """Reads a whole database through; returns how many rows each table has. Errors call it ``named``.

    Raises:
        StoreError: it is damaged.
    """
    with explained(str(named)), _reading(database) as connection:
        (found,) = connection.execute("PRAGMA integrity_check(1)").fetchone()
        orphan = connection.execute("PRAGMA foreign_key_check").fetchone()
        if found != "ok" or orphan:
            what = " ".join(found.split()) if found != "ok" else f"a row of {orphan[0]} belongs to none"
            raise StoreError(f"{named} is damaged ({what}); restore the latest backup.")
        return _counts(connection)


def copy_read_only(database: Path, copy: Path) -> None:
    """Copies a database that may not be written to: neither it nor anything beside it changes.

    Raises:
        StoreError: it cannot be read, or is being written.
    """
    for _ in range(TRIES):
        before = _state(database)
        with explained(str(database)):
            _copy_once(database, copy)
        if _log_of(database).exists() or _state(database) == before:
            return
    raise StoreError(f"{database} is being written; open it again in a moment.")


def _copy_once(database: Path, copy: Path) -> None:
    log, shared = _log_of(database), database.with_name(f"{database.name}-shm")
    if log.exists() and not shared.exists():
        # Nobody has it open: somebody copied a database that was, and its log is still to be read in.
        shutil.copyfile(log, _log_of(copy))
        shutil.copyfile(database, copy)
        return
    # Without a log, nobody has it open for writing; SQLite would make one to read it unless told so.
    with _reading(database, immutable=not log.exists()) as source, closing(sqlite3.connect(copy)) as target:
        source.backup(target)


@contextmanager
def _reading(database: Path, *, immutable: bool = False) -> Iterator[sqlite3.Connection]:
    options = "mode=ro&immutable=1" if immutable else "mode=ro"
    address = f"file:{quote(str(database.resolve()))}?{options}"
    with closing(sqlite3.connect(address, uri=True, isolation_level=None)) as connection:
        yield connection


def _counts(connection: sqlite3.Connection) -> dict[str, int]:
    listed = connection.execute(
        "SELECT name FROM sqlite_master WHERE type = 'table' AND name NOT LIKE 'sqlite!_%' ESCAPE '!'"
    )
    names = sorted(name for (name,) in listed)
    return {
        name: connection.execute(f'SELECT count(*) FROM "{name.replace(chr(34), 2 * chr(34))}"').fetchone()[0]
        for name in names
    }


def _log_of(database: Path) -> Path:
    return database.with_name(f"{database.name}-wal")


def _state(database: Path) -> tuple[int, int]:
    stat = database.stat()
    return stat.st_mtime_ns, stat.st_size
