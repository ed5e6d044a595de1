import logging
import re
import sqlite3
import threading
from contextlib import closing
from pathlib import Path

import pytest
from sqlalchemy import select, text

from fairyring.storage.db import engine, schema, upgrade
from fairyring.storage.db.engine import connect_engine, warn_of_network_drive
from fairyring.storage.db.schema import metadata
from fairyring.storage.errors import StoreError
from fairyring.storage.project import create_project, open_project


def insert_category(name):
    return lambda connection: connection.execute(schema.category.insert().values(name=name, extra={}))


def category_names(database: Path) -> list[str]:
    with sqlite3.connect(database) as connection:
        return [name for (name,) in connection.execute("SELECT name FROM category ORDER BY id")]


def test_a_project_opens_again_with_its_id_and_name(tmp_path):
    with create_project(tmp_path / "beds") as made:
        identity = made.id, made.name
    with open_project(tmp_path / "beds") as opened:
        assert (opened.id, opened.name) == identity
        assert opened.name == "beds"
        assert opened.images == tmp_path / "beds" / "images"
        assert opened.images.is_dir()


def test_a_name_with_quotes_survives_the_settings_file(tmp_path):
    folder = tmp_path / 'a "b" \\ ü'
    create_project(folder).close()
    with open_project(folder) as opened:
        assert opened.name == folder.name


def test_making_a_project_twice_is_refused(project):
    with pytest.raises(StoreError, match="is a Fairyring project already"):
        create_project(project.folder)


def test_a_folder_whose_settings_were_lost_keeps_its_project(project):
    project.write(insert_category("kept"))
    identity = project.id
    (project.folder / "fairyring.toml").unlink()
    with create_project(project.folder) as again:
        assert again.id == identity
    assert category_names(project.folder / "project.db") == ["kept"]


def test_a_folder_that_is_no_project_is_named_with_the_remedy(tmp_path):
    with pytest.raises(StoreError, match=r"not a Fairyring project; make one with: fairyring init"):
        open_project(tmp_path)


def test_a_project_without_its_database_says_so(project):
    project.close()
    for file in project.folder.glob("project.db*"):
        file.unlink()
    with pytest.raises(StoreError, match=r"has no project\.db"):
        open_project(project.folder)


def test_broken_settings_are_named(project):
    (project.folder / "fairyring.toml").write_text("[project\n")
    with pytest.raises(StoreError, match=r"fairyring\.toml cannot be read"):
        open_project(project.folder)


def test_a_folder_that_cannot_be_made_says_why(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(StoreError, match="cannot be made a project: Not a directory"):
        create_project(tmp_path / "file" / "beds")


def tables_of(database: Path) -> list[str]:
    with closing(sqlite3.connect(database)) as connection:
        return [name for (name,) in connection.execute("SELECT name FROM sqlite_master")]


def test_an_empty_database_is_not_filled_with_an_empty_project(project):
    project.close()
    for file in project.folder.glob("project.db*"):
        file.unlink()
    (project.folder / "project.db").touch()
    with pytest.raises(StoreError, match=r"project\.db is empty; restore it from a backup"):
        open_project(project.folder)
    (project.folder / "fairyring.toml").unlink()
    with pytest.raises(StoreError, match=r"project\.db is empty"):
        create_project(project.folder)
    assert (project.folder / "project.db").stat().st_size == 0


@pytest.mark.parametrize(
    "statement", ["CREATE TABLE project (id)", "CREATE TABLE alembic_version (version_num)"]
)
def test_the_database_of_another_program_is_left_alone(project, statement):
    project.close()
    for file in project.folder.glob("project.db*"):
        file.unlink()
    with closing(sqlite3.connect(project.folder / "project.db")) as connection:
        connection.execute(statement)
    before = (project.folder / "project.db").read_bytes()

    with pytest.raises(StoreError, match="another program's"):
        open_project(project.folder)
    (project.folder / "fairyring.toml").unlink()
    with pytest.raises(StoreError, match="another program's"):
        create_project(project.folder)
    assert (project.folder / "project.db").read_bytes() == before


def test_a_folder_may_be_called_anything(tmp_path):
    for name in ("beds?v2", "beds#1", "100 % beds", "beds&mode=ro", "ü%3F"):
        with create_project(tmp_path / name) as made:
            made.write(insert_category(name))
        with open_project(tmp_path / name) as opened:
            assert opened.name == name
        assert category_names(tmp_path / name / "project.db") == [name]
    assert len(list(tmp_path.iterdir())) == 5


@pytest.mark.parametrize("content", [b"not a database at all " * 400, b"SQLite format 3\0" + b"\xff" * 9000])
def test_a_damaged_database_asks_for_the_backup(tmp_path, content):
    create_project(tmp_path / "beds").close()
    for file in (tmp_path / "beds").glob("project.db*"):
        file.unlink()
    (tmp_path / "beds" / "project.db").write_bytes(content)
    with pytest.raises(StoreError, match="restore the latest backup"):
        open_project(tmp_path / "beds")


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


def test_a_database_url_is_kept_in_the_settings(tmp_path):
    url = f"sqlite:///{tmp_path / 'elsewhere.db'}"
    with create_project(tmp_path / "beds", url=url) as made:
        identity = made.id
    with open_project(tmp_path / "beds") as opened:
        assert opened.id == identity
    assert not (tmp_path / "beds" / "project.db").exists()
    with pytest.raises(StoreError, match="holds a project already"):
        create_project(tmp_path / "other", url=url)


def test_a_network_drive_is_warned_of(tmp_path, caplog):
    mounts = tmp_path / "mounts"
    mounts.write_text(f"/dev/sda / ext4 rw 0 0\nserver:/x {tmp_path} nfs4 rw 0 0\n")
    with caplog.at_level(logging.WARNING):
        warn_of_network_drive(tmp_path / "beds", mounts=mounts)
    assert "network drive (nfs4)" in caplog.text
    caplog.clear()
    warn_of_network_drive(Path("/usr"), mounts=mounts)
    assert caplog.text == ""
