"""Images taken out of a project: kept beside it with all that people said of them, until they are let go.

What the database held of such an image lies in a file of its own, and its photo beside that. Nothing else of
the project knows of it. Numbers are never given twice, not even to what a file calls by them, so that
everything can be put back as it was.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import msgspec
from msgspec import Struct
from sqlalchemy import Connection, Table, delete, select, text, update

from fairyring.storage.compared_classes import sum_up
from fairyring.storage.db import comparison_schema, schema
from fairyring.storage.db.bulk import insert_many
from fairyring.storage.db.clock import now
from fairyring.storage.db.rows import require_image
from fairyring.storage.errors import StoreError
from fairyring.storage.folder import IMAGES, TAKEN_OUT
from fairyring.storage.project import Project
from fairyring.storage.whole_folders import sync

TABLES: tuple[Table, ...] = (
    schema.image,
    schema.prediction,
    schema.annotation,
    schema.change_set,
    schema.edit,
    schema.status_change,
    schema.verdict,
    schema.repeat,
    comparison_schema.comparison,
    comparison_schema.compared_cap,
)
"""Those that hold something of an image, in the order in which rows refer to others; what
``compared_class`` sums up follows from them."""

DELETED = "_refuses_delete"
"""End of the names of the triggers that keep the journal whole."""


class TakenOut(Struct, frozen=True, kw_only=True):
    """An image that can be put back."""

    number: int
    file_name: str
    caps: int
    user: str
    made_at: str
    """When it was taken out: UTC, ISO 8601."""
    rows: dict[str, list[dict[str, Any]]]
    """By table."""


def take_out(project: Project, image_ids: Sequence[int], *, user: str) -> list[TakenOut]:
    """Takes images out, with their labels, predictions and history; returns what can be put back.

    Raises:
        StoreError: there is no such image, or the disk cannot be written to. Nothing is changed then.
    """
    project.require_writable()
    folder = project.folder / TAKEN_OUT

    def take(connection: Connection) -> list[TakenOut]:
        taken = [_read(connection, number, user=user) for number in image_ids]
        for each in taken:
            _write(folder, each)
        with _journal_open(connection):
            for table in reversed((*TABLES, comparison_schema.compared_class)):
                connection.execute(delete(table).where(_image_of(table).in_(image_ids)))
        return taken

    try:
        folder.mkdir(exist_ok=True)
        taken = project.write(take)
    except OSError as error:
        raise StoreError(f"{folder} cannot be written: {error.strerror}.") from error
    for each in taken:
        _move_photo(each, project.folder / _path_of(each), _photo_of(folder, each))
    return taken


def taken_out(project: Project) -> list[TakenOut]:
    """The images that can be put back, the last one first."""
    kept = _kept(project)
    with project.read() as connection:
        there = set(connection.execute(select(schema.image.c.id)).scalars())
    return sorted(
        (each for each in kept if each.number not in there), key=lambda each: each.made_at, reverse=True
    )


def numbers_taken_out(project: Project) -> dict[str, set[int]]:
    """The numbers, by table, of the images that can be put back and of what is theirs."""
    numbers: dict[str, set[int]] = {}
    for each in _kept(project):
        for table in (schema.image, schema.annotation, schema.prediction):
            own = numbers.setdefault(table.name, set())
            own.update(row["id"] for row in each.rows.get(table.name, []))
    return numbers


def put_back(project: Project, images: Sequence[TakenOut]) -> None:
    """Puts images back as they were.

    Raises:
        StoreError: another image has the name of one, or its caps, meanwhile. Nothing is changed then.
    """
    folder = project.folder / TAKEN_OUT

    def put(connection: Connection) -> None:
        for each in images:
            _require_free(connection, each)
            for table in TABLES:
                insert_many(connection, table, each.rows.get(table.name, []))
            caps, classes = comparison_schema.compared_cap.c, comparison_schema.compared_class.c
            sum_up(connection, caps.image == each.number, classes.image == each.number)
            # Whoever still holds it from before must read it anew.
            newer = schema.image.c.version + 1
            connection.execute(
                update(schema.image).where(schema.image.c.id == each.number).values(version=newer)
            )
        for each in images:
            _move_photo(each, _photo_of(folder, each), project.folder / _path_of(each))

    project.write(put)
    for each in images:
        _file_of(folder, each).unlink(missing_ok=True)


def let_go(project: Project) -> int:
    """Removes for good what could be put back; returns how many images that were."""
    if project.read_only or not (project.folder / TAKEN_OUT).exists():
        return 0
    gone = taken_out(project)
    for each in gone:
        photo = project.folder / _path_of(each)
        if _is_copied(each) and not _photo_of(project.folder / TAKEN_OUT, each).exists():
            photo.unlink(missing_ok=True)  # whoever took it out was killed before it was moved
    shutil.rmtree(project.folder / TAKEN_OUT, ignore_errors=True)
    return len(gone)


@contextmanager
def _journal_open(connection: Connection) -> Iterator[None]:
    """Lets rows of the journal be deleted in the block, within its transaction: all of an image, or none."""
    if connection.dialect.name != "sqlite":
        yield
        return
    found = text(f"SELECT name, sql FROM sqlite_master WHERE type = 'trigger' AND name LIKE '%{DELETED}'")
    triggers = connection.execute(found).all()
    for trigger in triggers:
        connection.exec_driver_sql(f"DROP TRIGGER {trigger.name}")
    yield
    for trigger in triggers:
        connection.exec_driver_sql(trigger.sql)


def _read(connection: Connection, number: int, *, user: str) -> TakenOut:
    image = require_image(connection, number)
    return TakenOut(
        number=number,
        file_name=image.file_name,
        caps=image.caps + image.ignored,
        user=user,
        made_at=now(),
        rows={table.name: list(_rows(connection, table, number)) for table in TABLES},
    )


def _rows(connection: Connection, table: Table, image: int) -> Iterator[dict[str, Any]]:
    statement = select(table).where(_image_of(table) == image).order_by(*table.primary_key)
    return (dict(row) for row in connection.execute(statement).mappings())


def _image_of(table: Table) -> Any:
    return table.c.id if table is schema.image else table.c.image


def _require_free(connection: Connection, each: TakenOut) -> None:
    named = select(schema.image.c.id).where(schema.image.c.file_name == each.file_name)
    if connection.execute(named).first() is not None:
        raise StoreError(f"Another image is called {each.file_name} now; take that one out first.")
    uids = {row["uid"] for row in each.rows.get(schema.annotation.name, [])}
    theirs = select(schema.annotation.c.uid, schema.image.c.file_name).join(schema.image)
    for row in connection.execute(theirs):
        if row.uid in uids:
            raise StoreError(f"{row.file_name} has caps of {each.file_name} now; take it out first.")


def _kept(project: Project) -> list[TakenOut]:
    files = (project.folder / TAKEN_OUT).glob("*.json")
    return [msgspec.json.decode(file.read_bytes(), type=TakenOut) for file in files]


def _file_of(folder: Path, each: TakenOut) -> Path:
    return folder / f"{each.number}.json"


def _photo_of(folder: Path, each: TakenOut) -> Path:
    """Where its photo is kept: by its number, as several that were taken out may have one name."""
    return folder / f"{each.number}.photo"


def _write(folder: Path, each: TakenOut) -> None:
    fresh = folder / f"{each.number}.part"
    fresh.write_bytes(msgspec.json.encode(each))
    sync(fresh)
    fresh.replace(_file_of(folder, each))
    sync(folder)


def _path_of(each: TakenOut) -> str:
    return each.rows["image"][0]["path"]


def _is_copied(each: TakenOut) -> bool:
    return _path_of(each).startswith(f"{IMAGES}/")


def _move_photo(each: TakenOut, source: Path, target: Path) -> None:
    """Moves a copied photo; one that is linked, or gone, stays as it is."""
    if _is_copied(each) and source.exists():
        target.parent.mkdir(parents=True, exist_ok=True)
        source.replace(target)
