"""What comparisons say of each cap: the worst of all images, and those that a figure counts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, get_args

from msgspec import Struct, structs
from sqlalchemy import ColumnElement, Connection, Table, and_, case, delete, func, insert, select, update

from fairyring.storage.cap_groups import Group, is_in
from fairyring.storage.compared_classes import sum_up
from fairyring.storage.db.comparison_schema import compared_cap, compared_class, comparison
from fairyring.storage.db.schema import annotation, image

Kind = Literal["worst", "matched", "missed", "extra", "doubtful", "unsure", "ignored"]
KINDS: tuple[Kind, ...] = get_args(Kind)


class CapFigures(Struct, frozen=True, kw_only=True):
    """A cap with the prediction that matches it; one of the two is None where there is no other."""

    image: int
    run: int
    annotation: str | None
    """Uid."""
    prediction: int | None
    iou: float | None = None
    cdr: float | None = None
    """CDR, percent (Eq. 10)."""
    floor: float | None = None
    """CDR that the mark has by itself, percent; as repeats of its annotator say, where there are enough."""
    own_floor: float | None = None
    """The same by the geometry of the mark alone."""
    dx: float | None = None
    """Predicted minus marked x, pixels; ``dy`` likewise."""
    dy: float | None = None
    annotator: str | None = None
    """Who edited it last; of an extra prediction who edited most caps of its image."""
    size: str | None = None
    """By what is seen of it; of an extra prediction as that shows it."""
    shape: str | None = None
    """Of its mark; of an extra prediction None, as is the next."""
    visibility: str | None = None
    doubtful: bool = False
    unsure: bool = False
    """Its mark hardly determines a centre."""
    ignored: bool = False
    """It counts neither way, so it is of no other kind."""


_C, _S = compared_cap.c, compared_class.c
_COUNTS = _C.ignored == 0
_WHICH: dict[Kind, ColumnElement[bool]] = {
    "worst": _C.cdr.is_not(None),
    "matched": and_(_C.annotation.is_not(None), _C.prediction.is_not(None)),
    "missed": and_(_COUNTS, _C.prediction.is_(None)),
    "extra": _C.annotation.is_(None),
    "doubtful": and_(_COUNTS, _C.doubtful == 1),
    "unsure": and_(_COUNTS, _C.unsure == 1),
    "ignored": _C.ignored == 1,
}
_HOW_MANY: dict[Kind, ColumnElement[Any]] = {
    "worst": _S.measured,
    "matched": _S.matched,
    "missed": case((_S.ignored == 0, _S.missed), else_=0),
    "extra": _S.extra,
    "doubtful": case((and_(_S.ignored == 0, _S.doubtful == 1), _S.caps), else_=0),
    "unsure": case((and_(_S.ignored == 0, _S.unsure == 1), _S.caps), else_=0),
    "ignored": case((_S.ignored == 1, _S.caps), else_=0),
}
"""How many caps of each kind a class has."""


def store_caps(connection: Connection, image_id: int, run_id: int, caps: Sequence[CapFigures]) -> None:
    """Stores the caps of an image and a run, in place of older ones; within ``Project.write``."""
    connection.execute(delete(compared_cap).where(_C.image == image_id, _C.run == run_id))
    if caps:
        connection.execute(insert(compared_cap), [structs.asdict(each) for each in caps])
    sum_up(
        connection,
        and_(_C.image == image_id, _C.run == run_id),
        and_(_S.image == image_id, _S.run == run_id),
    )


def scale_floors(
    connection: Connection,
    annotator: str,
    *,
    overall: float,
    by_class: Mapping[tuple[str | None, str | None, str | None], float],
) -> None:
    """Has the floors of somebody's marks be so many times those of their geometry; within ``Project.write``.

    Args:
        connection: to write by.
        annotator: whose marks.
        overall: for all marks of other classes than these.
        by_class: for marks of a size, shape and visible share.
    """
    of_person = update(compared_cap).where(_C.annotator == annotator)
    connection.execute(of_person.values(floor=_C.own_floor * overall))
    for (size, shape, visibility), times in by_class.items():
        of_class = of_person.where(
            _C.size.is_not_distinct_from(size),
            _C.shape.is_not_distinct_from(shape),
            _C.visibility.is_not_distinct_from(visibility),
        )
        connection.execute(of_class.values(floor=_C.own_floor * times))
    mean = (
        select(func.avg(_C.floor))
        .where(_C.image == comparison.c.image, _C.run == comparison.c.run, _C.cdr.is_not(None))
        .scalar_subquery()
    )
    theirs = select(_C.image).where(_C.annotator == annotator).distinct().scalar_subquery()
    sum_up(connection, _C.image.in_(theirs), _S.image.in_(theirs))
    connection.execute(update(comparison).where(comparison.c.image.in_(theirs)).values(floor_mean=mean))


def list_caps(
    connection: Connection,
    run_id: int,
    kind: Kind,
    *,
    group: Group | None = None,
    offset: int = 0,
    limit: int = 12,
) -> list[CapFigures]:
    """The caps of one kind, of all images that this run is the latest of, or those of a group among them.

    Those come first whose CDR passes the floor of their mark by most; where that says nothing, those whose
    outlines overlap least, then by image.

    Args:
        connection: to read by.
        run_id: against which run.
        kind: which caps.
        group: only those in it; one of a run is of that run, on whatever images.
        offset: how many to pass over.
        limit: how many at most.
    """
    excess = _C.cdr - func.coalesce(_C.floor, 0.0)
    rows = connection.execute(
        select(compared_cap)
        .join(image, image.c.id == _C.image)
        .where(*_among(compared_cap, run_id, group), _WHICH[kind])
        .order_by(excess.desc().nulls_last(), _C.iou.asc().nulls_last(), image.c.sort_name, _C.sequence)
        .offset(offset)
        .limit(limit)
    )
    return [_figures_of(row) for row in rows]


def caps_of_image(connection: Connection, run_id: int, image_id: int) -> list[CapFigures]:
    """What a comparison says of the caps of one image, in the order in which they were made."""
    rows = connection.execute(
        select(compared_cap)
        .outerjoin(annotation, annotation.c.uid == _C.annotation)
        .where(_C.run == run_id, _C.image == image_id)
        .order_by(annotation.c.id.nulls_last(), _C.sequence)
    )
    return [_figures_of(row) for row in rows]


def count_caps(connection: Connection, run_id: int, *, group: Group | None = None) -> dict[Kind, int]:
    """How many caps of each kind there are, as counted image by image, or among those of a group."""
    if group is not None:
        return _count_group(connection, run_id, group)
    counted = {kind: comparison.c["measured" if kind == "worst" else kind] for kind in KINDS}
    statement = (
        select(*(func.coalesce(func.sum(column), 0).label(kind) for kind, column in counted.items()))
        .select_from(comparison.join(image, image.c.id == comparison.c.image))
        .where(comparison.c.run == run_id, image.c.run == run_id)
    )
    row = connection.execute(statement).one()
    return {kind: getattr(row, kind) for kind in KINDS}


def _count_group(connection: Connection, run_id: int, group: Group) -> dict[Kind, int]:
    counted = {kind: func.coalesce(func.sum(column), 0) for kind, column in _HOW_MANY.items()}
    statement = (
        select(*(column.label(kind) for kind, column in counted.items()))
        .select_from(compared_class.join(image, image.c.id == _S.image))
        .where(*_among(compared_class, run_id, group))
    )
    row = connection.execute(statement).one()
    return {kind: getattr(row, kind) for kind in KINDS}


def _among(table: Table, run_id: int, group: Group | None) -> list[ColumnElement[bool]]:
    """Which rows of compared caps, or of their classes, are of a run or a group; joined to ``image``."""
    if group is not None and group.by == "run":
        return [is_in(group, table)]
    of_run = [table.c.run == run_id, image.c.run == run_id]
    return of_run if group is None else [*of_run, is_in(group, table)]


def _figures_of(row: Any) -> CapFigures:
    return CapFigures(**{name: getattr(row, name) for name in CapFigures.__struct_fields__})
