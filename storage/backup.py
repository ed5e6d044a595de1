"""Backups: folders that hold a project as it was at one moment, and are checked before they are relied on.

A backup holds the database, the settings, the copied photos and the weights, and a note (``backup.json``) of
what there is, by which a restore knows that nothing is missing or damaged. Linked photos stay where they are.
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import sqlite3
import tomllib
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path, PurePosixPath

import msgspec
from msgspec import Struct

from fairyring.model.progress import Progress, silent
from fairyring.storage.db.clock import now
from fairyring.storage.db.copying import copy_database
from fairyring.storage.db.upgrade import check_is_project
from fairyring.storage.errors import StoreError
from fairyring.storage.folder import DATABASE, IMAGES, NOTE_OF_BACKUP, SETTINGS, WEIGHTS
from fairyring.storage.project import Project
from fairyring.storage.serving import require_not_served
from fairyring.storage.whole_folders import made_whole, sync


class Backup(Struct, frozen=True, kw_only=True):
    """The note in a backup."""

    name: str
    """Of the project."""
    made_at: str
    """UTC, ISO 8601."""
    revision: str
    """Of the database's schema."""
    rows: dict[str, int]
    """How many each table has."""
    files: dict[str, str]
    """SHA-256 of every photo and file of weights, by its place in the backup."""
    linked: list[str]
    """Paths of photos that the project only points to; they are not in the backup."""
    remarks: list[str]
    """Sentences about photos that are gone, or no longer those that were imported."""

    @property
    def images(self) -> int:
        """How many images the project has."""
        return self.rows["image"]

    def files_in(self, folder: str) -> int:
        """How many files lie in ``images`` or ``weights``."""
        return sum(PurePosixPath(file).parts[0] == folder for file in self.files)


class _Photo(Struct, frozen=True):
    path: str
    sha256: str


def back_up(project: Project, out: Path, *, progress: Progress = silent) -> Backup:
    """Writes a backup into the new folder ``out``; all of it appears at once, or nothing does.

    People may go on working meanwhile. What is written is read back before it takes its name.

    Raises:
        StoreError: ``out`` exists or cannot be written, the database is damaged, or it is not SQLite's.
    """
    if out.exists():
        raise StoreError(f"{out} exists already; name a new folder for the backup.")
    if not out.parent.is_dir():
        raise StoreError(f"{out.parent} is not a folder; make it first, or name another for the backup.")
    database = project.sqlite_file
    if database is None:
        raise StoreError(
            f"{project.folder} is kept in a database server; back it up with the server's own tools."
        )
    with made_whole(out) as folder:
        progress(0, 0, "Copying the database")
        rows = copy_database(database, folder / DATABASE, named=project.folder / DATABASE)
        sync(folder / DATABASE)
        (folder / SETTINGS).write_text(_settings_without_store(project), encoding="utf-8")
        files, linked, remarks = _copy_photos(project, folder, progress)
        for weights in sorted((project.folder / WEIGHTS).glob("*.safetensors")):
            files[f"{WEIGHTS}/{weights.name}"] = _copy(weights, folder / WEIGHTS / weights.name)
        backup = Backup(
            name=project.name,
            made_at=now(),
            revision=check_is_project(folder / DATABASE),
            rows=rows,
            files=files,
            linked=linked,
            remarks=remarks,
        )
        (folder / NOTE_OF_BACKUP).write_bytes(msgspec.json.format(msgspec.json.encode(backup), indent=1))
        sync(folder / NOTE_OF_BACKUP)
    return backup


def restore(backup: Path, folder: Path, *, progress: Progress = silent) -> Backup:
    """Makes a project of a backup, in a new folder; all of it appears at once, or nothing does.

    Raises:
        StoreError: ``backup`` is none, is incomplete or damaged or of a newer Fairyring; ``folder`` holds
            something, is served or cannot be written.
    """
    note = read_note(backup)
    require_not_served(folder)
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise StoreError(f"{folder} exists already; name a new folder, or move that one away first.")
    with made_whole(folder) as fresh:
        progress(0, 0, "Copying the database")
        check_is_project(backup / DATABASE)
        database = backup / DATABASE
        if copy_database(database, fresh / DATABASE, named=database) != note.rows:
            raise StoreError(f"{database} is not what was backed up; take another backup.")
        sync(fresh / DATABASE)
        (fresh / IMAGES).mkdir()
        for done, (name, digest) in enumerate(sorted(note.files.items())):
            progress(done, len(note.files), "Copying photos and weights")
            if not (backup / name).is_file() or _copy(backup / name, fresh / name) != digest:
                raise StoreError(f"{backup / name} is gone or damaged; take another backup.")
        if not (backup / SETTINGS).is_file():
            raise StoreError(f"{backup / SETTINGS} is gone; take another backup.")
        _copy(backup / SETTINGS, fresh / SETTINGS)
    return note


def read_note(backup: Path) -> Backup:
    """What a backup holds.

    Raises:
        StoreError: it is none.
    """
    try:
        note = msgspec.json.decode((backup / NOTE_OF_BACKUP).read_bytes(), type=Backup)
    except OSError as error:
        raise StoreError(f"{backup} is no backup: {NOTE_OF_BACKUP} in it: {error.strerror}.") from error
    except msgspec.DecodeError as error:
        raise StoreError(f"{backup / NOTE_OF_BACKUP} is damaged ({error}); take another backup.") from error
    for name in note.files:
        first, *rest = name.split("/")
        if first not in (IMAGES, WEIGHTS) or not rest or {"", ".", ".."} & {*rest} or "\0" in name:
            raise StoreError(f"{backup / NOTE_OF_BACKUP} names {name!r:.60}, where no backup keeps anything.")
    return note


def _copy_photos(
    project: Project, folder: Path, progress: Progress
) -> tuple[dict[str, str], list[str], list[str]]:
    """Copies the photos that the copied database names: the digests of the copies, linked ones, remarks."""
    files: dict[str, str] = {}
    linked: list[str] = []
    remarks: list[str] = []
    photos = list(_photos_in(folder / DATABASE))
    (folder / IMAGES).mkdir()
    for done, photo in enumerate(photos):
        progress(done, len(photos), "Copying photos")
        place = PurePosixPath(photo.path)
        if place.parts[0] != IMAGES or ".." in place.parts:
            linked.append(photo.path)
            continue
        source = project.folder / photo.path
        if not source.is_file() or not os.access(source, os.R_OK, effective_ids=True):
            remarks.append(f"{source} is gone or cannot be read; the backup has its labels alone.")
            continue
        files[photo.path] = _copy(source, folder / photo.path)
        if files[photo.path] != photo.sha256:
            remarks.append(f"{source} is no longer the photo that was imported; the backup has it as it is.")
    return files, linked, remarks


def _photos_in(database: Path) -> Iterator[_Photo]:
    with closing(sqlite3.connect(database)) as connection:
        for path, sha256 in connection.execute("SELECT path, sha256 FROM image ORDER BY id"):
            yield _Photo(path, sha256)


def _copy(source: Path, target: Path) -> str:
    """Copies a file onto the disk; the SHA-256 of what is read back from there."""
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)
    sync(target)
    with target.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _settings_without_store(project: Project) -> str:
    """The settings without the address of the database: that of the backup lies beside them."""
    settings = project.folder / SETTINGS
    text = re.sub(r"(?ms)^\[store\].*?(?=^\[|\Z)", "", settings.read_text(encoding="utf-8"))
    if "store" in tomllib.loads(text):
        raise StoreError(f"{settings} names its database in an unusual way; put it under a line [store].")
    return text
