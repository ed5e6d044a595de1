"""Whether a database is whole, as a program sees it that has nothing to do with the server."""

from __future__ import annotations

import json
import sqlite3
from collections import Counter, defaultdict
from collections.abc import Collection, Mapping, Sequence
from contextlib import closing
from pathlib import Path


def faults_of(
    database: Path, *, acknowledged: Mapping[str, str], sent: Collection[str] | None = None
) -> list[str]:
    """What is wrong: with the file, with its journal, or with what was acknowledged.

    ``acknowledged`` names the annotation of each edit; ``sent`` are the ids of all edits there may be.
    """
    with closing(sqlite3.connect(database)) as connection:
        connection.row_factory = sqlite3.Row
        faults = [
            f"{check}: {tuple(row)}"
            for check in ("integrity_check", "foreign_key_check")
            for row in connection.execute(f"PRAGMA {check}")
            if tuple(row) != ("ok",)
        ]
        journal = connection.execute("SELECT * FROM edit ORDER BY sequence").fetchall()
        annotations = {row["uid"]: row for row in connection.execute("SELECT * FROM annotation")}
        counted = {row["id"]: row["caps"] for row in connection.execute("SELECT id, caps FROM image")}
    stored = Counter(row["id"] for row in journal)
    named = {row["id"]: row["annotation"] for row in journal}
    for edit, uid in acknowledged.items():
        if stored[edit] != 1 or named[edit] != uid:
            faults.append(
                f"acknowledged for {uid}, stored {stored[edit]} times, for {named.get(edit)}: {edit}"
            )
    faults += [f"sent by nobody: {edit}" for edit in stored if sent is not None and edit not in sent]
    stories: dict[str, list[sqlite3.Row]] = defaultdict(list)
    for row in journal:
        stories[row["annotation"]].append(row)
    for uid, rows in stories.items():
        faults += _faults_of_story(uid, rows, annotations.get(uid))
    live = Counter(row["image"] for row in annotations.values() if not row["deleted"] and not row["ignored"])
    faults += [
        f"image {image} has {live[image]} caps and says {caps}"
        for image, caps in counted.items()
        if live[image] != caps
    ]
    return faults


def _faults_of_story(uid: str, rows: Sequence[sqlite3.Row], now: sqlite3.Row | None) -> list[str]:
    """Of one cap's edits, each made on the one before, the last of which says how the cap is now."""
    if now is None:
        return [f"edits of a cap that is not there: {uid}"]
    faults = []
    before = after = None
    for number, row in enumerate(rows, start=1):
        before, after = after, json.loads(row["after"]) if row["after"] else None
        if (row["base"], row["revision"]) != (number - 1, number):
            faults.append(f"edit {number} of {uid} is of revision {row['revision']} on {row['base']}")
        if (json.loads(row["before"]) if row["before"] else None) != before:
            faults.append(f"edit {number} of {uid} says that another cap was there before")
    if now["revision"] != len(rows) or bool(now["deleted"]) != (after is None):
        faults.append(f"{uid} is of revision {now['revision']} after {len(rows)} edits")
    if after is not None and json.loads(now["visible"]) != after["visible"]:
        faults.append(f"{uid} is another cap than its last edit made it")
    return faults
