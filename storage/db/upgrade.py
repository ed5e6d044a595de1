"""Brings a database to the schema this program knows, by alembic."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection

from fairyring.storage.db.engine import connect_engine, explained
from fairyring.storage.errors import StoreError


def upgrade(url: str, *, source: Path, existing: Path | None = None) -> None:
    """Migrates the database at ``url`` in one transaction; an up-to-date one is left untouched.

    Args:
        url: SQLAlchemy URL.
        source: what errors name.
        existing: an SQLite file that already holds a project; it is backed up beside itself first.

    Raises:
        StoreError: made by a newer program, damaged, not writable.
    """
    config = Config()
    config.set_main_option("script_location", "fairyring.storage:migrations")
    head = ScriptDirectory.from_config(config).get_current_head()
    engine = connect_engine(url, write=True)
    try:
        with explained(str(source)), engine.begin() as connection:
            current = _current(connection, config, source)
            if current == head:
                return
            if existing is not None:
                _keep(existing, current)
            config.attributes["connection"] = connection
            command.upgrade(config, "head")
    finally:
        engine.dispose()


def _current(connection: Connection, config: Config, source: Path) -> str | None:
    current = MigrationContext.configure(connection).get_current_revision()
    known = {script.revision for script in ScriptDirectory.from_config(config).walk_revisions()}
    if current is not None and current not in known:
        raise StoreError(f"{source} was made by a newer Fairyring; update this program to open it.")
    return current


def _keep(database: Path, revision: str | None) -> None:
    """Backs the database up beside itself by SQLite's backup API, which is safe while others read it."""
    copy = database.with_name(f"{database.name}.before-{revision or 'first'}-upgrade")
    with closing(sqlite3.connect(database)) as source, closing(sqlite3.connect(copy)) as target:
        source.backup(target)
