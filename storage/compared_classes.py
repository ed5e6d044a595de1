"""Compared caps summed up by class: those of one image and run that are alike in all that figures go by.

A review of 60 000 caps reads some 5000 classes: figures of any group of caps are sums over these.
"""

from __future__ import annotations

from typing import Any

from sqlalchemy import ColumnElement, Connection, and_, case, delete, func, insert, select

from fairyring.storage.db.comparison_schema import compared_cap, compared_class

_C = compared_cap.c
_ALIKE = (
    *(_C.image, _C.run),
    *(_C.annotator, _C.size, _C.shape, _C.visibility),
    *(_C.doubtful, _C.unsure, _C.ignored),
)
_IS_MEASURED = _C.cdr.is_not(None)
_SUMS: dict[str, ColumnElement[Any]] = {
    "caps": func.count(),
    "measured": func.count(_C.cdr),
    "floors": func.count(case((_IS_MEASURED, _C.floor))),
    "matched": func.count(case((and_(_C.annotation.is_not(None), _C.prediction.is_not(None)), 1))),
    "missed": func.count(case((_C.prediction.is_(None), 1))),
    "extra": func.count(case((_C.annotation.is_(None), 1))),
    "cdr": func.sum(_C.cdr),
    "floor": func.sum(case((_IS_MEASURED, _C.floor))),
    "dx": func.sum(_C.dx),
    "dy": func.sum(_C.dy),
    "cdr_worst": func.max(_C.cdr),
}


def sum_up(connection: Connection, caps: ColumnElement[bool], classes: ColumnElement[bool]) -> None:
    """Sums some compared caps up anew, after these have changed; within ``Project.write``.

    Args:
        connection: to write by.
        caps: a condition on ``compared_cap``, of whole images or runs.
        classes: the same on ``compared_class``.
    """
    connection.execute(delete(compared_class).where(classes))
    columns = [column.name for column in _ALIKE] + list(_SUMS)
    summed = (column.label(name) for name, column in _SUMS.items())
    of_class = select(*_ALIKE, *summed).where(caps).group_by(*_ALIKE)
    connection.execute(insert(compared_class).from_select(columns, of_class))
