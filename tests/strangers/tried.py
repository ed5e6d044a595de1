"""Imports a stranger's file by the command, and says what the project holds then."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
from typer.testing import CliRunner

from fairyring.app.cli import app
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.shapes import Circle, Shape, area_of_outline, bounds_of_outline
from fairyring.storage.project import create_project
from tests.strangers import coco, labelme, others
from tests.strangers.bed import Stranger

ALL = [*coco.STRANGERS, *labelme.STRANGERS, *others.STRANGERS]


@dataclass(frozen=True, kw_only=True)
class Cap:
    """What the project knows of a cap: of its outline, else of its circle."""

    centre: tuple[float, float]
    area: float
    is_doubtful: bool = False


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What an import has made of a file."""

    exit_code: int
    photos: int
    caps: list[Cap]
    kind: str
    said: list[str]
    """Lines on stderr, without the folder."""


def tried(stranger: Stranger, folder: Path) -> Outcome:
    paths = stranger.make(folder / "in")
    project = folder / "project"
    create_project(project).close()
    done = CliRunner().invoke(app, ["import", str(project), *map(str, paths), *stranger.options])
    lines = done.stderr.splitlines()
    if isinstance(done.exception, FairyringError):
        # main() turns it into this line.
        lines.append(f"fairyring: {done.exception}")
    elif done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    table = "prediction" if stranger.predictions else "annotation"
    with closing(sqlite3.connect(project / "project.db")) as connection:
        (photos,) = connection.execute("SELECT count(*) FROM image").fetchone()
        rows = connection.execute(f"SELECT * FROM {table}")
        names = [column[0] for column in rows.description]
        found = [dict(zip(names, row, strict=True)) for row in rows]
    caps = [cap for _, cap in sorted(((row["image"], _cap(row)) for row in found), key=_from_the_left)]
    return Outcome(
        exit_code=done.exit_code,
        photos=photos,
        caps=caps,
        kind="predictions"
        if stranger.predictions
        else {"outline": "caps", "box": "boxes", "circle": "circles"}[stranger.shape],
        said=[line.replace(f"{folder}/in/", "") for line in lines],
    )


def _from_the_left(found: tuple[int, Cap]) -> tuple[int, float]:
    """Image by image, by the centres along x."""
    image, cap = found
    return image, cap.centre[0]


def _cap(row: dict[str, Any]) -> Cap:
    visible = msgspec.json.decode(row["visible"], type=list[list[float]])
    is_doubtful = bool(row.get("doubtful"))
    if not visible:
        mark = msgspec.json.decode(row["mark"], type=Shape)
        assert isinstance(mark, Circle)
        return Cap(centre=(mark.cx, mark.cy), area=3.14159 * mark.r**2, is_doubtful=is_doubtful)
    x, y, width, height = bounds_of_outline(visible)
    return Cap(centre=(x + width / 2, y + height / 2), area=area_of_outline(visible), is_doubtful=is_doubtful)
