"""What is on disk, read by a program that has nothing to do with the server."""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path
from typing import Any


def _query(project: Path, sql: str, *values: object) -> list[sqlite3.Row]:
    connection = sqlite3.connect(f"file:{project / 'project.db'}?mode=ro", uri=True)
    connection.row_factory = sqlite3.Row
    try:
        return connection.execute(sql, values).fetchall()
    finally:
        connection.close()


def kept_cap(project: Path, uid: str) -> dict[str, Any] | None:
    """One annotation as it is on disk; None where there is none."""
    rows = _query(project, "SELECT * FROM annotation WHERE uid = ?", uid)
    if not rows:
        return None
    row = dict(rows[0])
    for column in ("visible", "mark", "whole"):
        row[column] = json.loads(row[column]) if row[column] else None
    return row


def journal_of(project: Path, uid: str) -> list[dict[str, Any]]:
    """The edits of one annotation on disk, the first one first."""
    return [
        dict(r) for r in _query(project, "SELECT * FROM edit WHERE annotation = ? ORDER BY revision", uid)
    ]


def live_caps(project: Path) -> list[str]:
    """The uids of all live annotations on disk."""
    return [row["uid"] for row in _query(project, "SELECT uid FROM annotation WHERE deleted = 0")]


def all_caps(project: Path) -> list[str]:
    """The uids of all annotations on disk, deleted ones too."""
    return [row["uid"] for row in _query(project, "SELECT uid FROM annotation")]


def number_of_edits(project: Path) -> int:
    """How many edits the journal on disk has."""
    (row,) = _query(project, "SELECT count(*) AS edits FROM edit")
    return row["edits"]
