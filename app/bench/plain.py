"""A reference without Fairyring: what bare SQLite does on the same disk."""

from __future__ import annotations

import sqlite3
from pathlib import Path

from fairyring.app.bench.timing import milliseconds


def synced_inserts(path: Path, *, payload: str) -> list[float]:
    """Milliseconds that each of a hundred inserts takes bare SQLite, every one on disk before the next."""
    plain = _opened(path)
    insert = "INSERT INTO edit (payload) VALUES (?)"
    taken = milliseconds(lambda _: plain.execute(insert, (payload,)), range(100))
    plain.close()
    return taken


def inserted_at_once(path: Path, *, rows: int, payload: str) -> float:
    """Milliseconds that bare SQLite takes for one synced transaction of so many inserts."""
    plain = _opened(path)

    def insert(_: int) -> None:
        plain.execute("BEGIN")
        plain.executemany("INSERT INTO edit (payload) VALUES (?)", [(payload,)] * rows)
        plain.execute("COMMIT")

    taken = milliseconds(insert, range(3))
    plain.close()
    return min(taken)


def _opened(path: Path) -> sqlite3.Connection:
    plain = sqlite3.connect(path, isolation_level=None)
    plain.execute("PRAGMA journal_mode=WAL")
    plain.execute("PRAGMA synchronous=FULL")
    plain.execute("CREATE TABLE edit (id INTEGER PRIMARY KEY, payload TEXT)")
    return plain
