"""Writes come one after the other and are on the disk when they return."""

import sqlite3
import threading

import pytest
from sqlalchemy import select, text

from fairyring.storage.db import engine, schema
from fairyring.storage.errors import StoreError
from fairyring.storage.project import open_project
from tests.support.categories import category_names, insert_category


def test_connections_are_set_up_so_that_a_commit_is_on_disk(project):
    def pragmas(connection):
        names = ("journal_mode", "synchronous", "foreign_keys")
        return [connection.execute(text(f"PRAGMA {name}")).scalar() for name in names]

    assert project.write(pragmas) == ["wal", 2, 1]
    with project.read() as connection:
        assert pragmas(connection) == ["wal", 2, 1]


def test_what_a_write_raises_rolls_it_back(project):
    def work(connection):
        insert_category("lost")(connection)
        raise KeyError("stop")

    with pytest.raises(KeyError):
        project.write(work)
    with project.read() as connection:
        assert connection.execute(select(schema.category)).all() == []


def test_a_write_is_in_the_file_when_it_returns(project):
    project.write(insert_category("kept"))
    assert category_names(project.folder / "project.db") == ["kept"]


def test_a_reader_sees_one_state_while_others_write(project):
    with project.read() as connection:
        before = connection.execute(select(schema.category)).all()
        project.write(insert_category("later"))
        assert connection.execute(select(schema.category)).all() == before == []


def test_the_many_readers_keep_little_of_the_file_each(project):
    with project.read() as one, project.read() as another:
        kept_kib = [-reader.execute(text("PRAGMA cache_size")).scalar() for reader in (one, another)]
    assert sum(kept_kib) <= 1024


def test_writes_of_many_threads_come_one_after_the_other(project):
    def count_up(connection):
        count = len(connection.execute(select(schema.category.c.id)).all())
        insert_category(f"number {count}")(connection)

    threads = [threading.Thread(target=lambda: [project.write(count_up) for _ in range(5)]) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert category_names(project.folder / "project.db") == [f"number {n}" for n in range(30)]


def test_a_write_within_a_write_is_a_mistake_and_not_a_deadlock(project):
    with pytest.raises(RuntimeError, match="hand the connection on"):
        project.write(lambda _: project.write(insert_category("inner")))


def test_a_full_disk_is_told_in_a_sentence_and_loses_nothing(project):
    def fill(connection):
        pages = connection.execute(text("PRAGMA page_count")).scalar()
        connection.execute(text(f"PRAGMA max_page_count = {pages}"))
        for number in range(1000):
            insert_category(f"{number} {'x' * 500}")(connection)

    project.write(insert_category("before"))
    with pytest.raises(StoreError, match="the disk is full, so nothing of this change was stored"):
        project.write(fill)
    project.write(lambda connection: connection.execute(text("PRAGMA max_page_count = 1000000")))
    project.write(insert_category("after"))
    assert category_names(project.folder / "project.db") == ["before", "after"]


def test_a_database_locked_for_too_long_says_so(project, monkeypatch):
    monkeypatch.setattr(engine, "BUSY_SECONDS", 0)
    with (
        open_project(project.folder) as second,
        sqlite3.connect(project.folder / "project.db", isolation_level=None) as other,
    ):
        other.execute("BEGIN IMMEDIATE")
        with pytest.raises(StoreError, match="another program has locked the database"):
            second.write(insert_category("blocked"))
        other.execute("ROLLBACK")
        second.write(insert_category("free"))
