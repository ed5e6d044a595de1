"""Older databases are brought up to date, and no other database is touched."""

import re
import sqlite3

import pytest
from sqlalchemy import select, text

from fairyring.storage.db import schema, upgrade
from fairyring.storage.db.comparison_schema import metadata
from fairyring.storage.db.engine import connect_engine
from fairyring.storage.errors import StoreError
from fairyring.storage.project import create_project, open_project
from tests.support.categories import category_names, insert_category


def test_a_project_of_a_newer_program_is_left_alone(project):
    project.write(
        lambda connection: connection.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    )
    project.close()
    with pytest.raises(StoreError, match="made by a newer Fairyring; update this program"):
        open_project(project.folder)


def test_an_older_database_is_backed_up_before_it_is_migrated(project, monkeypatch):
    project.write(insert_category("button"))
    project.write(
        lambda connection: connection.execute(text("UPDATE alembic_version SET version_num = 'old'"))
    )
    project.close()
    monkeypatch.setattr(upgrade, "_revision_of", lambda *_: "old")
    monkeypatch.setattr(upgrade.command, "upgrade", lambda *_: None)
    open_project(project.folder).close()
    copy = project.folder / "project.db.before-old-upgrade"
    assert category_names(copy) == ["button"]


def test_a_migration_that_fails_changes_nothing(tmp_path, monkeypatch):
    def fail(config, _revision):
        config.attributes["connection"].execute(text("CREATE TABLE half (id INTEGER)"))
        raise RuntimeError("halfway")

    monkeypatch.setattr(upgrade.command, "upgrade", fail)
    with pytest.raises(RuntimeError, match="halfway"):
        create_project(tmp_path / "beds")
    with sqlite3.connect(tmp_path / "beds" / "project.db") as connection:
        assert connection.execute("SELECT name FROM sqlite_master").fetchall() == []


def test_a_fresh_migration_equals_the_tables(project, tmp_path):
    """Compares the SQL that SQLite keeps of both, column by column and index by index."""
    other = connect_engine(f"sqlite:///{tmp_path / 'plain.db'}", write=True)
    with other.begin() as connection:
        metadata.create_all(connection)

    def apart(sql):
        # A foreign key added later stands with its column.
        return re.sub(r"(\w+) (INTEGER) (CONSTRAINT \w+) (REFERENCES)", r"\1 \2, \3 FOREIGN KEY(\1) \4", sql)

    def parts(rows):
        return {
            # A column added later stands behind the last constraint, in its line.
            name: sorted(part.strip() for part in re.split(r"[,\n]", apart(sql)) if part.strip())
            for name, sql in rows
            if name != "alembic_version"
        }

    query = text("SELECT name, sql FROM sqlite_master WHERE type IN ('table', 'index') AND sql IS NOT NULL")
    with project.read() as migrated, other.connect() as plain:
        assert parts(migrated.execute(query)) == parts(plain.execute(query))


def test_every_table_is_strict_and_no_number_of_an_annotation_is_used_twice(project):
    with project.read() as connection:
        tables = {row.name: row.strict for row in connection.execute(text("PRAGMA table_list"))}
        numbered = {row.name for row in connection.execute(text("SELECT name FROM sqlite_sequence"))}
    ours = {name for name in tables if name in metadata.tables}
    assert ours == set(metadata.tables)
    assert all(tables[name] for name in ours)
    project.write(insert_category("a"))
    project.write(lambda connection: connection.execute(schema.category.delete()))
    project.write(insert_category("b"))
    with project.read() as connection:
        assert connection.execute(select(schema.category.c.id)).scalar_one() == 2
    assert numbered <= set(metadata.tables)


@pytest.mark.parametrize("table", ["edit", "status_change", "change_set"])
def test_the_journal_refuses_updates_and_deletions(project, table):
    with project.read() as connection:
        triggers = connection.execute(
            text("SELECT name FROM sqlite_master WHERE type = 'trigger' AND tbl_name = :table"),
            {"table": table},
        )
        assert sorted(triggers.scalars()) == [f"{table}_refuses_delete", f"{table}_refuses_update"]
