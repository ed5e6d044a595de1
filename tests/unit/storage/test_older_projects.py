"""Projects that older versions made are brought up to date, and keep what they hold."""

from __future__ import annotations

from pathlib import Path

import pytest
from alembic import command
from sqlalchemy import Connection, text

from fairyring.storage.contents import load_annotations, load_predictions
from fairyring.storage.db.engine import connect_engine
from fairyring.storage.db.upgrade import _config
from fairyring.storage.image_history import list_change_sets
from fairyring.storage.journal import commit, history
from fairyring.storage.project import Project, create_project, open_project
from fairyring.storage.records import Cap, StatusEdit
from fairyring.storage.reversals import next_reversal
from tests.support.edits import one
from tests.unit.storage.conftest import SQUARE, TRIANGLE

NOON = "2026-03-01T12:00:0"


def older_project(folder: Path, revision: str, *statements: str) -> Path:
    """A project folder whose database is as the version of this revision made it."""
    create_project(folder).close()
    for file in folder.glob("project.db*"):
        file.unlink()
    engine = connect_engine(f"sqlite:///{folder / 'project.db'}", write=True)
    with engine.begin() as connection:
        config = _config()
        config.attributes["connection"] = connection
        command.upgrade(config, revision)
        fill(connection)
        for statement in statements:
            connection.exec_driver_sql(statement)
    engine.dispose()
    return folder


def fill(connection: Connection) -> None:
    """One photo and one category."""
    connection.execute(
        text("INSERT INTO project (id, name, made_at) VALUES ('p', 'beds', '2026-03-01T11:00:00.000Z')")
    )
    connection.execute(text("INSERT INTO category (name, extra) VALUES ('mushroom', '{}')"))
    connection.execute(
        text(
            "INSERT INTO image (file_name, sort_name, path, width, height, sha256, status, extra, added_at) "
            "VALUES ('bed.png', 'bed.png', 'images/bed.png', 100, 80, '', 'approved', '{}', '2026-03-01')"
        )
    )


def cap_of(uid: str, *, revision: int, deleted: bool) -> str:
    return (
        "INSERT INTO annotation (uid, image, revision, deleted, visible, ignored, doubtful, category, extra, "
        f"edited_by, edited_at) VALUES ('{uid}', 1, {revision}, {int(deleted)}, '{SQUARE}', 0, 0, 1, '{{}}', "
        "'ann', '2026-03-01')"
    )


def edit_of(uid: str, revision: int, when: str, *, user: str = "ann", before: bool, after: bool) -> str:
    cap = f"'{{\"visible\": {SQUARE}}}'"
    return (
        "INSERT INTO edit (id, digest, annotation, image, base, revision, before, after, user, made_at) "
        f"VALUES ('{uid}-{revision}', 'd', '{uid}', 1, {revision - 1}, {revision}, "
        f"{cap if before else 'NULL'}, {cap if after else 'NULL'}, '{user}', '{NOON}{when}Z')"
    )


@pytest.fixture
def upgraded(tmp_path: Path) -> Project:
    """Ann imported two caps at once, deleted both, Bob brought one back; then he approved the photo."""
    folder = older_project(
        tmp_path / "beds",
        "0002",
        *(cap_of("a", revision=2, deleted=True), cap_of("b", revision=3, deleted=False)),
        *(edit_of(uid, 1, "1.000", before=False, after=True) for uid in "ab"),
        *(edit_of(uid, 2, when, before=True, after=False) for uid, when in (("a", "3.000"), ("b", "3.004"))),
        edit_of("b", 3, "3.100", user="bob", before=False, after=True),
        "INSERT INTO status_change (image, before, after, user, made_at) "
        f"VALUES (1, 'new', 'approved', 'bob', '{NOON}4.000Z')",
    )
    return open_project(folder)


def test_what_was_done_at_once_is_one_change_set(upgraded: Project) -> None:
    with upgraded, upgraded.read() as connection:
        told_of = list_change_sets(connection, 1).change_sets
        told = [(s.user, s.made, s.deleted, s.brought_back, s.status) for s in told_of]
        assert told == [
            ("bob", 0, 0, 0, ("new", "approved")),
            ("bob", 0, 0, 1, None),
            ("ann", 0, 2, 0, None),
            ("ann", 2, 0, 0, None),
        ]


def test_what_was_done_before_the_upgrade_can_be_taken_back_after_it(upgraded: Project) -> None:
    with upgraded, upgraded.read() as connection:
        found = next_reversal(connection, 1, user="ann", way="undo")
        assert found is not None
        assert [(r.annotation.uid, r.cap) for r in found.returns] == [("a", Cap(visible=SQUARE))]
        assert found.changed_since == 1
        of_bob = next_reversal(connection, 1, user="bob", way="undo")
        assert of_bob is not None
        assert of_bob.status == ("approved", "new")


def test_work_goes_on_and_the_journal_is_append_only_again(upgraded: Project) -> None:
    with upgraded:
        assert one(upgraded, "e", annotation="b", base=3, cap=Cap(visible=TRIANGLE)).annotation.revision == 4
        with upgraded.read() as connection:
            assert [entry.revision for entry in history(connection, "b")] == [1, 2, 3, 4]
            assert len(load_annotations(connection, 1)) == 1
            names = connection.execute(
                text("SELECT name FROM sqlite_master WHERE type = 'trigger'")
            ).scalars()
            assert len(list(names)) == 8


def test_a_backup_of_the_older_database_is_kept(tmp_path: Path) -> None:
    folder = older_project(tmp_path / "beds", "0001")
    open_project(folder).close()
    assert (folder / "project.db.before-0001-upgrade").is_file()


def test_statuses_sent_after_the_upgrade_have_numbers_beside_the_old_ones(upgraded: Project) -> None:
    made = StatusEdit(id="s", image=1, before="approved", after="new")
    with upgraded:
        commit(upgraded, [], statuses=[made], user="ann")
        with upgraded.read() as connection:
            ids = connection.execute(text("SELECT id FROM status_change ORDER BY sequence")).scalars()
            assert list(ids) == ["status-1", "s"]


def test_of_predictions_from_before_the_upgrade_no_quality_is_known(tmp_path: Path) -> None:
    older_project(
        tmp_path / "beds",
        "0007",
        "INSERT INTO run (name, kind, made_at, settings) VALUES ('r', 'network', '2026-03-01', '{}')",
        "INSERT INTO prediction (run, image, uid, category, visible, score, extra) "
        "VALUES (1, 1, 'u', 1, '[[0,0,9,0,9,9]]', 0.75, '{}')",
        "UPDATE image SET run = 1",
    )
    with open_project(tmp_path / "beds") as project, project.read() as connection:
        (prediction,) = load_predictions(connection, 1)
    assert (prediction.score, prediction.quality) == (0.75, None)
