"""What comparisons say of each cap: the worst of all images, and those that a figure counts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, get_args

from msgspec import Struct, structs
from sqlalchemy import ColumnElement, Connection, case, delete, func, insert, select

from fairyring.storage.db.schema import compared_cap, image

Kind = Literal["worst", "missed", "extra", "doubtful", "unsure"]
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
    """CDR that the mark has by itself, percent."""
    doubtful: bool = False
    unsure: bool = False
    """Its mark hardly determines a centre."""


_C = compared_cap.c
_WHICH: dict[Kind, ColumnElement[bool]] = {
    "worst": _C.cdr.is_not(None),
    "missed": _C.prediction.is_(None),
    "extra": _C.annotation.is_(None),
    "doubtful": _C.doubtful == 1,
    "unsure": _C.unsure == 1,
}


def store_caps(connection: Connection, image_id: int, run_id: int, caps: Sequence[CapFigures]) -> None:
    """Stores the caps of an image and a run, in place of older ones; within ``Project.write``."""
    connection.execute(delete(compared_cap).where(_C.image == image_id, _C.run == run_id))
    if caps:
        connection.execute(insert(compared_cap), [structs.asdict(each) for each in caps])


def list_caps(
    connection: Connection, run_id: int, kind: Kind, *, offset: int = 0, limit: int = 12
) -> list[CapFigures]:
    """The caps of one kind, of all images that this run is the latest of.

    Those come first whose CDR passes the floor of their mark by most; where that says nothing, those whose
    outlines overlap least, then by image.
    """
    excess = _C.cdr - func.coalesce(_C.floor, 0.0)
    rows = connection.execute(
        select(compared_cap)
        .join(image, image.c.id == _C.image)
        .where(_C.run == run_id, image.c.run == run_id, _WHICH[kind])
        .order_by(excess.desc().nulls_last(), _C.iou.asc().nulls_last(), image.c.sort_name, _C.sequence)
        .offset(offset)
        .limit(limit)
    )
    return [_figures_of(row) for row in rows]


def count_caps(connection: Connection, run_id: int) -> dict[Kind, int]:
    """How many caps of each kind there are."""
    counts = [func.coalesce(func.sum(case((_WHICH[kind], 1), else_=0)), 0).label(kind) for kind in KINDS]
    statement = (
        select(*counts)
        .select_from(compared_cap.join(image, image.c.id == _C.image))
        .where(_C.run == run_id, image.c.run == run_id)
    )
    row = connection.execute(statement).one()
    return {kind: getattr(row, kind) for kind in KINDS}


def _figures_of(row: Any) -> CapFigures:
    return CapFigures(**{name: getattr(row, name) for name in CapFigures.__struct_fields__})
