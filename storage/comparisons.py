"""Review figures kept per image and run, and which of them an edit has made stale."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

from msgspec import Struct, structs
from sqlalchemy import ColumnElement, Connection, delete, func, insert, null, select

from fairyring.storage.compared_caps import CapFigures, store_caps
from fairyring.storage.db.clock import now
from fairyring.storage.db.comparison_schema import comparison
from fairyring.storage.db.schema import image
from fairyring.storage.review_figures import sure_figures

ComparisonSort = Literal["name", "caps", "marked", "missed", "extra", "cdr_mean", "cdr_worst"]


SURE = ("matched", "missed", "extra", "measured", "cdr_mean", "cdr_worst", "floor_mean", "dx", "dy")
"""The figures that are others where doubtful caps and unsure marks are left out."""


class Comparison(Struct, frozen=True, kw_only=True):
    """The annotations of an image against the predictions of a run."""

    image: int
    run: int
    version: int
    """``contents.load_version`` from before the caps were loaded; a later edit makes this stale."""
    caps: int
    marked: int
    """Caps whose mark gives a true centre."""
    matched: int
    missed: int
    extra: int
    measured: int = 0
    """Marked caps with a prediction, whose centres can be compared."""
    doubtful: int = 0
    unsure: int = 0
    """Caps whose mark hardly determines a centre."""
    ignored: int = 0
    """Caps that count neither way; of no other kind."""
    cdr_mean: float | None = None
    """Mean CDR, percent (Eq. 10)."""
    iou_mean: float | None = None
    """Mean IoU of the visible outlines of the pairs."""
    floor_mean: float | None = None
    """Mean CDR that the marks of these caps have by themselves; None where it is not known."""
    cdr_worst: float | None = None
    worst: str | None = None
    """Uid of the annotation with the worst CDR."""
    px_mean: float | None = None
    relative_mean: float | None = None
    """Mean error as a share of the cap's diameter."""
    dx: float | None = None
    """Signed mean error along x, pixels, predicted minus marked; ``dy`` along y."""
    dy: float | None = None


class ComparisonRow(Struct, frozen=True, kw_only=True):
    """One line of the review."""

    file_name: str
    comparison: Comparison
    stale: bool


class ComparisonPage(Struct, frozen=True, kw_only=True):
    """Some lines of the review, and how many there are in all."""

    rows: list[ComparisonRow]
    total: int


def store_comparison(connection: Connection, figures: Comparison, *, caps: Sequence[CapFigures] = ()) -> None:
    """Stores the figures of an image and a run, and of its caps, in place of older ones."""
    store_caps(connection, figures.image, figures.run, caps)
    connection.execute(
        delete(comparison).where(comparison.c.image == figures.image, comparison.c.run == figures.run)
    )
    connection.execute(insert(comparison).values(**structs.asdict(figures), made_at=now()))


def list_comparisons(
    connection: Connection,
    run_id: int,
    *,
    sort: ComparisonSort = "cdr_worst",
    descending: bool = True,
    only_sure: bool = False,
    offset: int = 0,
    limit: int = 50,
) -> ComparisonPage:
    """The review of a run. Images without a figure come last either way.

    ``only_sure`` has the figures be those without doubtful caps and unsure marks, which name no worst cap.
    """
    figures: dict[str, ColumnElement[Any]] = dict(comparison.c.items())
    source = comparison.join(image, image.c.id == comparison.c.image)
    if only_sure:
        sure = sure_figures(run_id)
        source = source.outerjoin(sure, sure.c.image == comparison.c.image)
        figures |= {"worst": null(), **{name: sure.c[name] for name in SURE}}
    column: ColumnElement[Any] = image.c.sort_name if sort == "name" else figures[sort]
    directed = (column.desc() if descending else column.asc()).nulls_last()
    of_run = comparison.c.run == run_id
    statement = (
        select(
            *(figures[name].label(name) for name in Comparison.__struct_fields__),
            image.c.file_name,
            (image.c.version != comparison.c.version).label("stale"),
        )
        .select_from(source)
        .where(of_run)
        .order_by(directed, image.c.sort_name, image.c.id)
        .offset(offset)
        .limit(limit)
    )
    total = connection.execute(select(func.count()).select_from(comparison).where(of_run)).scalar_one()
    rows = [
        ComparisonRow(file_name=row.file_name, comparison=_comparison_of(row), stale=bool(row.stale))
        for row in connection.execute(statement)
    ]
    return ComparisonPage(rows=rows, total=total)


def stale_images(connection: Connection, run_id: int) -> list[int]:
    """Images with caps whose figures against this run, their latest, are missing or out of date."""
    statement = (
        select(image.c.id)
        .outerjoin(comparison, (comparison.c.image == image.c.id) & (comparison.c.run == run_id))
        .where(
            image.c.run == run_id,
            image.c.caps + image.c.ignored > 0,
            comparison.c.version.is_(None) | (comparison.c.version != image.c.version),
        )
        .order_by(image.c.id)
    )
    return list(connection.execute(statement).scalars())


def _comparison_of(row: Any) -> Comparison:
    """Of a row that begins with its fields: by their names a page of 1000 takes twice as long."""
    return Comparison(**dict(zip(Comparison.__struct_fields__, row, strict=False)))
