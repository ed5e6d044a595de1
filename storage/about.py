"""What a project holds, in figures: images, caps, marks, runs, splits, people, disk."""

from __future__ import annotations

import os
from pathlib import Path

from msgspec import Struct
from sqlalchemy import ColumnElement, Connection, func, select

from fairyring.storage.db.schema import annotation, edit, image, prediction, run
from fairyring.storage.derived import count_underived
from fairyring.storage.folder import CACHE, IMAGES, TAKEN_OUT, WEIGHTS
from fairyring.storage.project import Project
from fairyring.storage.records import STATUSES
from fairyring.storage.taken_out import taken_out


class RunFigures(Struct, frozen=True, kw_only=True):
    """One run of predictions."""

    number: int
    name: str
    made_at: str
    images: int
    caps: int


class PersonFigures(Struct, frozen=True, kw_only=True):
    """What one person has done."""

    name: str
    edits: int
    last: str
    """When they last edited: UTC, ISO 8601."""


class Figures(Struct, frozen=True, kw_only=True):
    """All of a project."""

    name: str
    images: int
    status: dict[str, int]
    """Images by status."""
    splits: dict[str, int]
    """Images by split; those of none under an empty name."""
    linked: int
    """Images whose photo lies outside the project."""
    taken_out: int
    """Images that can be put back."""
    caps: int
    """Live annotations that are not ignored."""
    marks: int
    """How many of them have a mark."""
    ignored: int
    doubtful: int
    lacking: int
    """Caps and predictions whose whole outline is found when it is first needed."""
    predictions: int
    runs: list[RunFigures]
    people: list[PersonFigures]
    disk: dict[str, int]
    """Bytes."""


def figures_of(project: Project) -> Figures:
    """Counts what a project holds."""
    with project.read() as connection:
        live = annotation.c.deleted == 0
        counted = live & (annotation.c.ignored == 0)
        return Figures(
            name=project.name,
            images=_count(connection, image.c.id > 0),
            status={status: _count(connection, image.c.status == status) for status in STATUSES},
            splits=images_by_split(connection),
            linked=_count(connection, ~image.c.path.startswith(f"{IMAGES}/")),
            taken_out=len(taken_out(project)),
            caps=_count(connection, counted),
            marks=_count(connection, counted & annotation.c.mark.is_not(None)),
            ignored=_count(connection, live & (annotation.c.ignored == 1)),
            doubtful=_count(connection, live & (annotation.c.doubtful == 1)),
            lacking=count_underived(connection),
            predictions=_count(connection, prediction.c.id > 0),
            runs=_runs(connection),
            people=_people(connection),
            disk=_disk(project),
        )


def _count(connection: Connection, condition: ColumnElement[bool]) -> int:
    return connection.execute(select(func.count()).where(condition)).scalar_one()


def images_by_split(connection: Connection) -> dict[str, int]:
    """How many images are in each split; those in none under an empty name."""
    statement = (
        select(image.c.split, func.count()).group_by(image.c.split).order_by(image.c.split.nulls_last())
    )
    return {split or "": count for split, count in connection.execute(statement)}


def _runs(connection: Connection) -> list[RunFigures]:
    statement = (
        select(
            run.c.id,
            run.c.name,
            run.c.made_at,
            func.count(prediction.c.image.distinct()),
            func.count(prediction.c.id),
        )
        .outerjoin(prediction, prediction.c.run == run.c.id)
        .group_by(run.c.id)
        .order_by(run.c.id)
    )
    return [
        RunFigures(number=number, name=name, made_at=made_at, images=images, caps=caps)
        for number, name, made_at, images, caps in connection.execute(statement)
    ]


def _people(connection: Connection) -> list[PersonFigures]:
    statement = (
        select(edit.c.user, func.count(), func.max(edit.c.made_at))
        .group_by(edit.c.user)
        .order_by(edit.c.user)
    )
    return [
        PersonFigures(name=name, edits=edits, last=last)
        for name, edits, last in connection.execute(statement)
    ]


def _disk(project: Project) -> dict[str, int]:
    database = project.sqlite_file
    sizes = {
        "database": sum(_size(file) for file in database.parent.glob(f"{database.name}*")) if database else 0
    }
    return sizes | {name: _size(project.folder / name) for name in (IMAGES, WEIGHTS, CACHE, TAKEN_OUT)}


def _size(path: Path) -> int:
    if path.is_file():
        return path.stat().st_size
    return sum((Path(parent) / name).lstat().st_size for parent, _, files in os.walk(path) for name in files)
