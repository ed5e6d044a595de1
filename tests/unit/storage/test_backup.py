"""Backups that hold everything, and are not there unless they do."""

from __future__ import annotations

import json
import random
import shutil
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest
from sqlalchemy import text

from fairyring.storage.backup import back_up, read_note, restore
from fairyring.storage.contents import load_annotations
from fairyring.storage.errors import StoreError
from fairyring.storage.images import ImageFilter, list_images
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import history
from fairyring.storage.project import Project, create_project, open_project
from fairyring.storage.records import Cap
from fairyring.storage.serving import served
from tests.support.exported import SQUARE, store


@pytest.fixture
def worked_on(beds: Project) -> Project:
    """Three photos, a cap in two of them, weights and a setting."""
    for image in (1, 3):
        store(beds, Cap(visible=[SQUARE]), image=image)
    (beds.folder / "weights").mkdir()
    (beds.folder / "weights" / "mine.safetensors").write_bytes(b"weights")
    with (beds.folder / "fairyring.toml").open("a") as settings:
        settings.write("[serve]\nport = 8123\n")
    return beds


def files_in(folder: Path) -> dict[str, bytes]:
    return {str(f.relative_to(folder)): f.read_bytes() for f in folder.rglob("*") if f.is_file()}


def test_a_restored_project_is_the_project(worked_on: Project, tmp_path: Path) -> None:
    made = back_up(worked_on, tmp_path / "backup")
    assert (made.images, made.files_in("images"), made.files_in("weights")) == (3, 3, 1)
    assert (made.rows["annotation"], made.rows["edit"], made.linked, made.remarks) == (2, 2, [], [])

    assert restore(tmp_path / "backup", tmp_path / "again") == made

    before, after = files_in(worked_on.folder), files_in(tmp_path / "again")
    same = {name for name in after if name != "project.db"}
    assert same == {name for name in before if not name.startswith((".", "project.db"))}
    assert all(after[name] == before[name] for name in same)
    with open_project(tmp_path / "again") as again, again.read() as new, worked_on.read() as old:
        assert (again.id, again.name) == (worked_on.id, worked_on.name)
        assert list_images(new, ImageFilter()) == list_images(old, ImageFilter())
        for image in (1, 2, 3):
            assert load_annotations(new, image) == load_annotations(old, image)
        assert history(new, "3_0") == history(old, "3_0")


def test_a_backup_is_of_one_moment_while_others_write(worked_on: Project, tmp_path: Path) -> None:
    with worked_on.read() as connection:
        connection.execute(text("SELECT count(*) FROM annotation")).all()
        store(worked_on, Cap(visible=[SQUARE]), image=2)
        made = back_up(worked_on, tmp_path / "backup")
    assert made.rows["annotation"] == 3
    with closing(sqlite3.connect(tmp_path / "backup" / "project.db")) as copied:
        assert copied.execute("PRAGMA journal_mode").fetchone() == ("delete",)
        assert copied.execute("SELECT count(*) FROM edit").fetchone() == (3,)


def test_nothing_is_overwritten(worked_on: Project, tmp_path: Path) -> None:
    back_up(worked_on, tmp_path / "backup")
    with pytest.raises(StoreError, match="exists already; name a new folder"):
        back_up(worked_on, tmp_path / "backup")
    with pytest.raises(StoreError, match="is not a folder; make it first"):
        back_up(worked_on, tmp_path / "nowhere" / "backup")
    before = files_in(worked_on.folder)
    with pytest.raises(StoreError, match="exists already; name a new folder, or move that one away"):
        restore(tmp_path / "backup", worked_on.folder)
    with (
        served(worked_on.folder, address="http://localhost:8080"),
        pytest.raises(StoreError, match="is served already at http://localhost:8080"),
    ):
        restore(tmp_path / "backup", worked_on.folder)
    assert files_in(worked_on.folder).keys() - before.keys() == {".served"}


def test_a_backup_is_not_opened_as_a_project(worked_on: Project, tmp_path: Path) -> None:
    back_up(worked_on, tmp_path / "backup")
    with pytest.raises(StoreError, match="is a backup; make a project of it with: fairyring restore"):
        open_project(tmp_path / "backup")


def test_what_a_backup_lacks_is_said(worked_on: Project, tmp_path: Path) -> None:
    shutil.copy(worked_on.images / "bed_1.png", tmp_path / "elsewhere.png")
    with (tmp_path / "elsewhere.png").open("ab") as file:
        file.write(b" ")
    import_paths(worked_on, [tmp_path / "elsewhere.png"], link=True)
    (worked_on.images / "bed_1.png").unlink()
    (worked_on.images / "bed_2.png").write_bytes(b"another")

    made = back_up(worked_on, tmp_path / "backup")

    assert made.linked == [str(tmp_path / "elsewhere.png")]
    assert [remark.removeprefix(str(worked_on.images)) for remark in made.remarks] == [
        "/bed_1.png is gone or cannot be read; the backup has its labels alone.",
        "/bed_2.png is no longer the photo that was imported; the backup has it as it is.",
    ]
    restore(tmp_path / "backup", tmp_path / "again")
    assert (tmp_path / "again" / "images" / "bed_2.png").read_bytes() == b"another"


@pytest.mark.parametrize("lost", ["a page", "the end"])
def test_a_damaged_database_is_not_backed_up(worked_on: Project, tmp_path: Path, lost: str) -> None:
    filled = random.Random(0)
    worked_on.write(
        lambda connection: connection.execute(
            text("INSERT INTO category (name, extra) VALUES (:name, '{}')"),
            [{"name": f"{filled.random()} {'x' * 300}"} for _ in range(400)],
        )
    )
    worked_on.close()
    file = worked_on.folder / "project.db"
    content = bytearray(file.read_bytes())
    if lost == "a page":
        middle = len(content) // 2 // 4096 * 4096
        content[middle : middle + 8192] = bytes(8192)
    else:
        del content[-8192:]
    file.write_bytes(content)
    before = sorted(tmp_path.iterdir())

    with pytest.raises(StoreError, match=r"project\.db.* damaged"), open_project(worked_on.folder) as damaged:
        back_up(damaged, tmp_path / "backup")

    assert sorted(tmp_path.iterdir()) == before


ON_A_FULL_DISK = """
import resource, sys
from pathlib import Path
from fairyring.app.cli import main
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[1]), resource.RLIM_INFINITY))
sys.argv = ["fairyring", *sys.argv[2:]]
main()
"""


@pytest.mark.parametrize("largest", [4096, 70_000, 150_000])
def test_on_a_full_disk_it_says_so_and_leaves_nothing_behind(
    worked_on: Project, tmp_path: Path, largest: int
) -> None:
    """No file may grow beyond that: first the database finds no room, then a photo."""
    (worked_on.folder / "weights" / "large.safetensors").write_bytes(bytes(200_000))
    before = sorted(tmp_path.iterdir())
    arguments = ["backup", str(worked_on.folder), str(tmp_path / "backup")]

    ran = subprocess.run(
        [sys.executable, "-c", ON_A_FULL_DISK, str(largest), *arguments],
        capture_output=True,
        text=True,
        check=False,
    )

    assert ran.returncode == 1, ran.stderr
    assert ran.stderr.startswith("fairyring: "), ran.stderr
    assert "Traceback" not in ran.stderr
    assert sorted(tmp_path.iterdir()) == before


def test_a_backup_that_was_damaged_since_is_not_restored(worked_on: Project, tmp_path: Path) -> None:
    back_up(worked_on, tmp_path / "whole")
    damages = {
        "images/bed_2.png": lambda file: file.write_bytes(file.read_bytes()[:-1]),
        "weights/mine.safetensors": lambda file: file.unlink(),
        "project.db": lambda file: file.write_bytes(b""),
        "fairyring.toml": lambda file: file.unlink(),
        "backup.json": lambda file: file.write_bytes(file.read_bytes()[:100]),
    }
    for name, damage in damages.items():
        shutil.copytree(tmp_path / "whole", tmp_path / "backup")
        damage(tmp_path / "backup" / name)
        with pytest.raises(StoreError, match=name.split("/")[-1]):
            restore(tmp_path / "backup", tmp_path / "again")
        shutil.rmtree(tmp_path / "backup")
        assert not (tmp_path / "again").exists(), name


def test_a_database_that_lost_rows_since_is_not_restored(worked_on: Project, tmp_path: Path) -> None:
    back_up(worked_on, tmp_path / "backup")
    with closing(sqlite3.connect(tmp_path / "backup" / "project.db")) as copied:
        copied.execute("DELETE FROM project")
        copied.commit()
    with pytest.raises(StoreError, match=r"project\.db is not what was backed up"):
        restore(tmp_path / "backup", tmp_path / "again")


def test_a_note_that_names_other_places_is_not_followed(worked_on: Project, tmp_path: Path) -> None:
    back_up(worked_on, tmp_path / "backup")
    note = tmp_path / "backup" / "backup.json"
    document = json.loads(note.read_text())
    for name in (
        "../secret",
        "images/../../secret",
        "/etc/passwd",
        "images/..",
        "images/",
        "images//a",
        "project.db",
    ):
        note.write_text(json.dumps(document | {"files": {name: "0" * 64}}))
        with pytest.raises(StoreError, match="where no backup keeps anything"):
            read_note(tmp_path / "backup")


def test_a_folder_that_is_no_backup_says_so(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match="is no backup"):
        restore(tmp_path, tmp_path / "again")


def test_the_restored_project_has_its_own_database(tmp_path: Path) -> None:
    with create_project(tmp_path / "beds", url=f"sqlite:///{tmp_path / 'elsewhere.db'}") as made:
        back_up(made, tmp_path / "backup")
    restore(tmp_path / "backup", tmp_path / "again")
    with open_project(tmp_path / "again") as again:
        assert again.sqlite_file == tmp_path / "again" / "project.db"
        assert again.name == "beds"
