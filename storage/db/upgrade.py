"""Brings a database to the schema this program knows, by alembic."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import URL, Connection, Engine, inspect

from fairyring.storage.db import schema
from fairyring.storage.db.copying import copy_database
from fairyring.storage.db.engine import connect_engine, connect_read_only, explained
from fairyring.storage.errors import StoreError

HEADER = b"SQLite format 3\x00"


def make_tables(url: str | URL, *, source: Path) -> None:
    """Brings an empty database, or one that holds a project, to the current schema.

    Args:
        url: of the database.
        source: what errors name.

    Raises:
        StoreError: it holds another program's tables, was made by a newer Fairyring, is damaged or read-only.
    """
    engine = connect_engine(url, write=True)
    try:
        with explained(str(source)), engine.begin() as connection:
            _migrate(connection, _revision_of(connection, source))
    finally:
        engine.dispose()


def upgrade(url: str | URL, *, source: Path, file: Path | None = None) -> None:
    """Brings the database of a project to the current schema in one transaction, unless it has that already.

    Args:
        url: of the database.
        source: what errors name.
        file: where it lies, if it is SQLite's; it is backed up beside itself first.

    Raises:
        StoreError: it holds no project, was made by a newer Fairyring, is damaged or read-only.
    """
    revision = check_is_project(file) if file else _revision_at(url, source)
    if revision == _head():
        return
    if file is not None:
        _keep(file, revision)
    engine = connect_engine(url, write=True)
    try:
        with explained(str(source)), engine.begin() as connection:
            _migrate(connection, _revision_of(connection, source))
    finally:
        engine.dispose()


def check_is_project(file: Path) -> str:
    """The revision of the project in an SQLite file; looks without changing anything.

    Raises:
        StoreError: it is empty, damaged, of another program or of a newer Fairyring.
    """
    try:
        with file.open("rb") as opened:
            begin = opened.read(len(HEADER))
    except OSError as error:
        raise StoreError(f"{file} cannot be read: {error.strerror}.") from error
    if not begin:
        raise StoreError(f"{file} is empty; restore it from a backup.")
    if begin != HEADER:
        raise StoreError(f"{file} is not a Fairyring database or is damaged; restore the latest backup.")
    revision = _revision_by(connect_read_only(file), file)
    if revision is None:
        raise StoreError(f"{file} holds no project; restore it from a backup.")
    return revision


def holds_nothing(file: Path) -> bool:
    """Whether an SQLite file has been begun, but has no table. Raises StoreError where it is another's."""
    return file.stat().st_size > 0 and _revision_by(connect_read_only(file), file) is None


def _revision_at(url: str | URL, source: Path) -> str:
    revision = _revision_by(connect_engine(url, write=False), source)
    if revision is None:
        raise StoreError(f"The database of {source} holds no project; give back the one it had.")
    return revision


def _revision_by(engine: Engine, source: Path) -> str | None:
    """What ``_revision_of`` says of an engine's database; the engine is done with then."""
    try:
        with explained(str(source)), engine.connect() as connection:
            return _revision_of(connection, source)
    finally:
        engine.dispose()


def _revision_of(connection: Connection, source: Path) -> str | None:
    """None where the database holds nothing at all."""
    tables = set(inspect(connection).get_table_names())
    if not tables:
        return None
    current = MigrationContext.configure(connection).get_current_revision()
    if current is None or schema.project.name not in tables:
        raise StoreError(f"{source}: the database is another program's; restore a backup, or move it away.")
    if current not in {script.revision for script in _scripts().walk_revisions()}:
        raise StoreError(f"{source} was made by a newer Fairyring; update this program to open it.")
    return current


def _migrate(connection: Connection, revision: str | None) -> None:
    if revision != _head():
        config = _config()
        config.attributes["connection"] = connection
        command.upgrade(config, "head")


def _config() -> Config:
    config = Config()
    config.set_main_option("script_location", "fairyring.storage:migrations")
    return config


@cache
def _scripts() -> ScriptDirectory:
    return ScriptDirectory.from_config(_config())


def _head() -> str | None:
    return _scripts().get_current_head()


def _keep(database: Path, revision: str) -> None:
    """Backs the database up beside itself."""
    copy = database.with_name(f"{database.name}.before-{revision}-upgrade")
    copy.unlink(missing_ok=True)
    copy_database(database, copy, named=database)
