"""The figures of a whole review, straight from the store: of all images, of groups, and how centres shift."""

from __future__ import annotations

from typing import Any

from msgspec import Struct
from sqlalchemy import ColumnElement, Connection, Row, Select, Subquery, and_, case, func, select

from fairyring.storage.cap_groups import By, column_of
from fairyring.storage.db.comparison_schema import compared_cap, compared_class, comparison
from fairyring.storage.db.schema import image

_C, _S = compared_cap.c, compared_class.c
_COUNTED = {name: func.coalesce(func.sum(_S[name]), 0) for name in ("measured", "matched", "missed", "extra")}
_MEANS: dict[str, ColumnElement[Any]] = {
    name: func.sum(_S[name]) / func.nullif(func.sum(_S[count]), 0)
    for name, count in (("cdr", "measured"), ("floor", "floors"), ("dx", "measured"), ("dy", "measured"))
}
_FIGURES = _COUNTED | _MEANS


class Totals(Struct, frozen=True, kw_only=True):
    """Figures of some caps against a run."""

    measured: int
    """Marked caps with a prediction, of which the means are; None each where there are none."""
    matched: int
    missed: int
    extra: int
    cdr: float | None
    """Mean CDR, percent (Eq. 10)."""
    floor: float | None
    """Mean CDR that the marks have by themselves, percent."""
    dx: float | None
    """Mean signed error along x, pixels, predicted minus marked; ``dy`` along y."""
    dy: float | None


class Shift(Struct, frozen=True, kw_only=True):
    """Where the predicted centre of a cap lies from the marked one, pixels."""

    image: int
    annotation: str
    dx: float
    dy: float


def totals(connection: Connection, run_id: int, *, only_sure: bool = False) -> Totals:
    """Figures of all images that this run is the latest of.

    Args:
        connection: to read by.
        run_id: against which run.
        only_sure: without doubtful caps and marks that hardly determine a centre.
    """
    if only_sure:
        (found,) = [_totals(row) for row in connection.execute(_of_classes(run_id, only_sure=True))]
        return found
    latest = select(image.c.id).where(image.c.run == run_id)
    return totals_among(connection, run_id, latest)


def marked_caps(connection: Connection, run_id: int) -> int:
    """How many caps of the images that this run is the latest of have a mark that gives a centre."""
    marked = select(func.coalesce(func.sum(comparison.c.marked), 0))
    of_run = marked.select_from(comparison.join(image, image.c.id == comparison.c.image))
    return connection.execute(of_run.where(comparison.c.run == run_id, image.c.run == run_id)).scalar_one()


def totals_among(connection: Connection, run_id: int, images: Select[tuple[int]]) -> Totals:
    """Figures of the images that a query names, against a run that need not be their latest."""
    statement = _of_images().where(comparison.c.run == run_id, comparison.c.image.in_(images))
    return _totals(connection.execute(statement).one())


def totals_by(
    connection: Connection, run_id: int, by: By, *, only_sure: bool = False
) -> dict[str | None, Totals]:
    """The same of caps of each light, form, size …, so that they add up to the whole.

    Those of which it is not known stand under None; nothing is where it is known of none. By run it is all
    that each run was compared on, under its number.
    """
    if by == "run" and not only_sure:
        statement = _of_images().add_columns(comparison.c.run.label("value")).group_by(comparison.c.run)
    else:
        column = column_of(by, compared_class)
        of_classes = _of_classes(None if by == "run" else run_id, only_sure=only_sure)
        statement = of_classes.add_columns(column.label("value")).group_by(column)
    rows = {row.value: _totals(row) for row in connection.execute(statement)}
    found = {None if value is None else str(value): of for value, of in rows.items()}
    return found if {*found} - {None} else {}


def sure_figures(run_id: int) -> Subquery:
    """The figures of each image without doubtful caps and unsure marks, named as those of a comparison."""
    figures = _FIGURES | {
        "cdr_mean": _FIGURES["cdr"],
        "cdr_worst": func.max(_S.cdr_worst),
        "floor_mean": _FIGURES["floor"],
    }
    return (
        select(_S.image, *(column.label(name) for name, column in figures.items()))
        .where(_S.run == run_id, *_counting(only_sure=True))
        .group_by(_S.image)
        .subquery("sure")
    )


def shifts(connection: Connection, run_id: int, *, only_sure: bool = False, most: int = 3000) -> list[Shift]:
    """How measured centres shift; of more than ``most`` caps as many, spread evenly over all of them."""
    measured = totals(connection, run_id, only_sure=only_sure).measured
    step = max(1, -(-measured // most))
    sure = [_C.unsure == 0, _C.doubtful == 0] if only_sure else []
    rows = connection.execute(
        select(_C.image, _C.annotation, _C.dx, _C.dy)
        .join(image, image.c.id == _C.image)
        .where(_C.run == run_id, _C.dx.is_not(None), *sure, image.c.run == run_id, _C.sequence % step == 0)
        .order_by(_C.sequence)
    )
    return [Shift(image=row.image, annotation=row.annotation, dx=row.dx, dy=row.dy) for row in rows]


def untouched(connection: Connection, *, most: int = 20) -> tuple[int, list[str]]:
    """How many images nobody has worked on, which count nowhere, and the file names of the first of them."""
    waiting = and_(image.c.status == "new", image.c.caps + image.c.ignored == 0)
    count = connection.execute(select(func.count()).select_from(image).where(waiting)).scalar_one()
    names = select(image.c.file_name).where(waiting).order_by(image.c.sort_name, image.c.id).limit(most)
    return count, list(connection.execute(names).scalars())


def _of_images() -> Select[Any]:
    """Figures of all comparisons, from those of their images."""
    c = comparison.c
    weighted = {
        name: func.sum(c[column] * c.measured) / func.nullif(func.sum(_counted(c[column])), 0)
        for name, column in (("cdr", "cdr_mean"), ("floor", "floor_mean"), ("dx", "dx"), ("dy", "dy"))
    }
    counts = {
        name: func.coalesce(func.sum(c[name]), 0) for name in ("measured", "matched", "missed", "extra")
    }
    return select(*(column.label(name) for name, column in (counts | weighted).items()))


def _of_classes(run_id: int | None, *, only_sure: bool) -> Select[Any]:
    """Figures of the caps of the images that a run is the latest of; of all runs and images for None."""
    of_run = [] if run_id is None else [_S.run == run_id, image.c.run == run_id]
    return (
        select(*(column.label(name) for name, column in _FIGURES.items()))
        .select_from(compared_class.join(image, image.c.id == _S.image))
        .where(*of_run, *_counting(only_sure=only_sure))
    )


def _counting(*, only_sure: bool) -> list[ColumnElement[bool]]:
    sure = [_S.unsure == 0, _S.doubtful == 0] if only_sure else []
    return [_S.ignored == 0, *sure]


def _counted(column: ColumnElement[Any]) -> ColumnElement[Any]:
    """How many caps a mean is of: none where it is not known."""
    return case((column.is_not(None), comparison.c.measured), else_=0)


def _totals(row: Row[Any]) -> Totals:
    return Totals(**{name: getattr(row, name) for name in Totals.__struct_fields__})
