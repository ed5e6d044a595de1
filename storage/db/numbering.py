"""Numbers of rows that come from files: kept where they are free, so that exports call things the same."""

from __future__ import annotations

from collections.abc import Iterable

from sqlalchemy import Connection, Table, func, select

HIGHEST = 1_000_000_000
"""Highest number that is kept: the database counts on from there, and knows no number twice as high."""
CHUNK = 500
"""How many numbers are asked for in one statement."""


def free_numbers(
    connection: Connection,
    table: Table,
    wanted: Iterable[int | None],
    *,
    lowest: int = 1,
    kept: Iterable[int] = (),
) -> list[int | None]:
    """Each wanted number that no row has; None for the others, and for all but the first of those alike.

    ``kept``: numbers of rows that may come back.
    """
    asked = [number if number is not None and lowest <= number <= HIGHEST else None for number in wanted]
    distinct = list(dict.fromkeys(number for number in asked if number is not None))
    taken: set[int] = set(kept)
    for start in range(0, len(distinct), CHUNK):
        which = table.c.id.in_(distinct[start : start + CHUNK])
        taken.update(connection.execute(select(table.c.id).where(which)).scalars())
    free: list[int | None] = []
    for number in asked:
        is_free = number is not None and number not in taken
        free.append(number if is_free else None)
        if number is not None:
            taken.add(number)
    return free


def count_on(connection: Connection, table: Table) -> None:
    """Has the database number the next row above all that were given numbers; SQLite does so by itself."""
    if connection.dialect.name == "postgresql":
        sequence = func.pg_get_serial_sequence(table.name, "id")
        highest = select(func.max(table.c.id)).scalar_subquery()
        connection.execute(select(func.setval(sequence, func.greatest(func.nextval(sequence), highest))))
