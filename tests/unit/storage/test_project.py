"""Projects are made, opened again, and refused where they are none."""

import itertools
import logging
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
from sqlalchemy import Engine, event

from fairyring.storage.db.engine import warn_of_network_drive
from fairyring.storage.errors import StoreError
from fairyring.storage.project import create_project, open_project
from tests.support.categories import category_names, insert_category


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


def test_a_database_url_is_kept_in_the_settings(tmp_path):
    url = f"sqlite:///{tmp_path / 'elsewhere.db'}"
    with create_project(tmp_path / "beds", url=url) as made:
        identity = made.id
    with open_project(tmp_path / "beds") as opened:
        assert opened.id == identity
    assert not (tmp_path / "beds" / "project.db").exists()
    with pytest.raises(StoreError, match="holds a project already"):
        create_project(tmp_path / "other", url=url)


@pytest.mark.parametrize("url", ["nodatabase://host/beds", "beds", "sqlite:////nowhere/at/all.db"])
def test_a_database_that_cannot_be_reached_is_told_and_leaves_no_folder(tmp_path, url):
    with pytest.raises(StoreError, match=r"cannot be (reached|opened)"):
        create_project(tmp_path / "beds", url=url)
    assert not (tmp_path / "beds").exists()


def test_a_network_drive_is_warned_of(tmp_path, caplog):
    mounts = tmp_path / "mounts"
    mounts.write_text(f"/dev/sda / ext4 rw 0 0\nserver:/x {tmp_path} nfs4 rw 0 0\n")
    with caplog.at_level(logging.WARNING):
        warn_of_network_drive(tmp_path / "beds", mounts=mounts)
    assert "network drive (nfs4)" in caplog.text
    caplog.clear()
    warn_of_network_drive(Path("/usr"), mounts=mounts)
    assert caplog.text == ""


@pytest.mark.parametrize("stopped_at", [2, 30, 70, 90])
def test_making_a_project_goes_on_where_it_was_stopped(tmp_path, stopped_at):
    statements = itertools.count(1)

    def stop(*_: object) -> None:
        if next(statements) == stopped_at:
            raise KeyboardInterrupt

    event.listen(Engine, "before_cursor_execute", stop)
    try:
        with pytest.raises(KeyboardInterrupt):
            create_project(tmp_path / "beds")
    finally:
        event.remove(Engine, "before_cursor_execute", stop)
    with create_project(tmp_path / "beds") as project:
        assert project.name == "beds"


def test_a_database_that_lost_its_tables_is_no_new_project_where_there_are_photos(tmp_path):
    create_project(tmp_path / "beds").close()
    (tmp_path / "beds/images/bed.png").write_bytes(b"a photo")
    for name in ("fairyring.toml", "project.db"):
        (tmp_path / "beds" / name).unlink()
    (tmp_path / "beds/project.db").touch()
    with pytest.raises(StoreError, match="is empty; restore it from a backup"):
        create_project(tmp_path / "beds")
