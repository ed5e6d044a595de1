"""How far a project is, and who worked on it."""

from __future__ import annotations

from msgspec import Struct
from sqlalchemy import Connection, func, select

from fairyring.storage.db.schema import edit, run, status_change, verdict

IMPORT = "import"
"""Whom the journal names for imports, unless somebody says who did it."""


class Standing(Struct, frozen=True, kw_only=True):
    """How far a project is."""

    edits: int
    """Number of the last edit of a cap; grows with every one."""
    changed_at: str | None
    """When caps, statuses, verdicts or runs were last changed, UTC, ISO 8601; None where nothing ever was."""
    people: list[str]
    """Who edited caps or statuses or gave verdicts, imports aside, by name."""


def standing_of(connection: Connection) -> Standing:
    """How far the project is: the same as long as nobody changes it."""
    times = [
        connection.execute(select(func.max(table.c.made_at))).scalar_one()
        for table in (edit, status_change, verdict, run)
    ]
    people = {
        name
        for table in (edit, status_change, verdict)
        for name in connection.execute(select(table.c.user).distinct()).scalars()
    }
    return Standing(
        edits=connection.execute(select(func.max(edit.c.sequence))).scalar_one() or 0,
        changed_at=max((time for time in times if time), default=None),
        people=sorted(people - {IMPORT}),
    )
