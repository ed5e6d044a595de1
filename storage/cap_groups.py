"""What compared caps are grouped by: their kind, whose they are, their image, and the run."""

from __future__ import annotations

from typing import Any, Literal, get_args

from msgspec import Struct
from sqlalchemy import ColumnElement, Table, and_, false, select

from fairyring.storage.db.comparison_schema import comparison
from fairyring.storage.db.rows import is_number
from fairyring.storage.db.schema import image

By = Literal["light", "form", "size", "visibility", "shape", "annotator", "image", "run"]
BY: tuple[By, ...] = get_args(By)


class Group(Struct, frozen=True, kw_only=True):
    """Compared caps that have something in common."""

    by: By
    value: str | None
    """None of those of which it is not known; of an image and a run its number."""
    image: int | None = None
    """Only those of this image."""
    beside: int | None = None
    """Only those of images that were compared with this run as well."""


def column_of(by: By, table: Table) -> ColumnElement[Any]:
    """What says to which group a cap belongs.

    Args:
        by: the kind of group.
        table: of compared caps, or of their classes; the query joins it to ``image``.
    """
    return image.c[by] if by in ("light", "form") else table.c[by]


def is_in(group: Group, table: Table) -> ColumnElement[bool]:
    """Whether a compared cap, or a class of them, belongs to a group; ``table`` as for ``column_of``."""
    among = _of_images(group, table)
    return and_(_has_value(group, table), *among) if among else _has_value(group, table)


def _of_images(group: Group, table: Table) -> list[ColumnElement[bool]]:
    """What a group says of the images that its caps are on."""
    found: list[ColumnElement[bool]] = []
    if group.image is not None:
        found.append(table.c.image == group.image if is_number(group.image) else false())
    if group.beside is not None:
        seen = select(comparison.c.image).where(comparison.c.run == group.beside)
        found.append(table.c.image.in_(seen) if is_number(group.beside) else false())
    return found


def _has_value(group: Group, table: Table) -> ColumnElement[bool]:
    column = column_of(group.by, table)
    if group.value is None:
        return column.is_(None)
    if group.by not in ("image", "run"):
        return column == group.value
    number = number_of(group)
    return false() if number is None else column == number


def number_of(group: Group) -> int | None:
    """The number of the image or run that a group is of; None where it is no number."""
    value = group.value or ""
    return int(value) if value.isdecimal() and len(value) < 19 and is_number(int(value)) else None
