"""Edits and changes of status that were made together have a change set in common.

Of older edits that is not known. They are put together where one person made them on one image at about the
same time: a transaction took milliseconds, and what hands do one after the other takes longer.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from datetime import datetime, timedelta
from typing import Any, NamedTuple

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None

TOGETHER = timedelta(milliseconds=200)
"""Longest pause between two edits of one change set."""
ANSWERED = ("edit", "status_change")
JOURNAL = (*ANSWERED, "change_set")


class _Group(NamedTuple):
    """Rows of one table that become one change set."""

    table: str
    image: int
    user: str
    made_at: str
    first: int
    last: int


def upgrade() -> None:
    """Makes the table and its columns, and fills them in for what is there already."""
    _make_table()
    _add_columns()
    on_sqlite = op.get_bind().dialect.name == "sqlite"
    if on_sqlite:
        for table in ANSWERED:
            op.execute(f"DROP TRIGGER {table}_refuses_update")
    _fill_in(op.get_bind())
    if on_sqlite:
        for table in ANSWERED:
            _refuse(table, "UPDATE")
        for change in ("UPDATE", "DELETE"):
            _refuse("change_set", change)


def _refuse(table: str, change: str) -> None:
    op.execute(
        f"CREATE TRIGGER {table}_refuses_{change.lower()} BEFORE {change} ON {table} "
        f"BEGIN SELECT RAISE(ABORT, 'the journal is append-only'); END"
    )


def _make_table() -> None:
    op.create_table(
        "change_set",
        sa.Column("sequence", sa.Integer(), nullable=False),
        sa.Column("id", sa.Text(), nullable=False),
        sa.Column("image", sa.Integer(), nullable=False),
        sa.Column("user", sa.Text(), nullable=False),
        sa.Column("made_at", sa.Text(), nullable=False),
        sa.Column("takes_back", sa.Text()),
        sa.ForeignKeyConstraint(["image"], ["image.id"], name=op.f("fk_change_set_image")),
        sa.PrimaryKeyConstraint("sequence", name=op.f("pk_change_set")),
        sa.UniqueConstraint("image", "user", "id", name=op.f("uq_change_set_image_user_id")),
        sqlite_autoincrement=True,
        sqlite_strict=True,
    )


def _add_columns() -> None:
    op.add_column("status_change", sa.Column("id", sa.Text()))
    op.add_column("status_change", sa.Column("digest", sa.Text()))
    for table in ANSWERED:
        if op.get_bind().dialect.name == "sqlite":
            op.execute(
                f"ALTER TABLE {table} ADD COLUMN change_set INTEGER "
                f"CONSTRAINT fk_{table}_change_set REFERENCES change_set (sequence)"
            )
        else:
            name = op.f(f"fk_{table}_change_set")
            op.add_column(table, sa.Column("change_set", sa.Integer()))
            op.create_foreign_key(name, table, "change_set", ["change_set"], ["sequence"])
        op.create_index(op.f(f"ix_{table}_change_set"), table, ["change_set"], unique=False)
    op.create_index(op.f("ix_status_change_id"), "status_change", ["id"], unique=True)


def _fill_in(connection: sa.Connection) -> None:
    groups = sorted(
        [*_groups(connection, "edit", TOGETHER), *_groups(connection, "status_change", timedelta(0))],
        key=lambda group: group.made_at,
    )
    sets = sa.table("change_set", *map(sa.column, ("sequence", "id", "image", "user", "made_at")))
    for number, group in enumerate(groups, start=1):
        values = {"sequence": number, "id": f"{group.table}-{group.first}"}
        connection.execute(sa.insert(sets).values(**values, **_named(group)))
        connection.execute(
            sa.text(f"UPDATE {group.table} SET change_set = :number WHERE sequence BETWEEN :first AND :last"),
            {"number": number, "first": group.first, "last": group.last},
        )
    if connection.dialect.name == "postgresql" and groups:
        connection.execute(
            sa.text("SELECT setval(pg_get_serial_sequence('change_set', 'sequence'), :last)"),
            {"last": len(groups)},
        )
    connection.execute(
        sa.text("UPDATE status_change SET id = 'status-' || CAST(sequence AS TEXT), digest = 'unknown'")
    )


def _named(group: _Group) -> dict[str, Any]:
    return {"image": group.image, "user": group.user, "made_at": group.made_at}


def _groups(connection: sa.Connection, table: str, pause: timedelta) -> Iterator[_Group]:
    columns = sa.table(table, *map(sa.column, ("sequence", "image", "user", "made_at")))
    rows = connection.execute(sa.select(columns).order_by(columns.c.sequence))
    return _grouped(table, rows, pause)


def _grouped(table: str, rows: Iterable[Any], pause: timedelta) -> Iterator[_Group]:
    group: _Group | None = None
    ended = datetime.min
    for row in rows:
        made = datetime.fromisoformat(row.made_at).replace(tzinfo=None)
        same = group is not None and (group.image, group.user) == (row.image, row.user)
        if group is not None and same and pause and abs(made - ended) <= pause:
            group = group._replace(last=row.sequence)
        else:
            if group is not None:
                yield group
            group = _Group(table, row.image, row.user, row.made_at, row.sequence, row.sequence)
        ended = made
    if group is not None:
        yield group
