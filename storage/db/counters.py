"""Keeps the counters of ``image`` true after its annotations or predictions changed."""

from __future__ import annotations

from collections.abc import Iterable

from sqlalchemy import Connection, ScalarSelect, bindparam, func, select, update

from fairyring.storage.db.schema import annotation, image, prediction


def recount(connection: Connection, image_ids: Iterable[int]) -> None:
    """Counts an image's caps and predictions anew, and makes figures computed before stale."""
    rows = [{"which": image_id} for image_id in sorted(set(image_ids))]
    if rows:
        connection.execute(_RECOUNT, rows)


def _live(*, ignored: bool) -> ScalarSelect[int]:
    return (
        select(func.count())
        .where(
            annotation.c.image == image.c.id,
            annotation.c.deleted == 0,
            annotation.c.ignored == int(ignored),
        )
        .scalar_subquery()
    )


_PREDICTED = (
    select(func.count())
    .where(prediction.c.image == image.c.id, prediction.c.run == image.c.run)
    .scalar_subquery()
)

_RECOUNT = (
    update(image)
    .where(image.c.id == bindparam("which"))
    .values(
        caps=_live(ignored=False),
        ignored=_live(ignored=True),
        predicted=_PREDICTED,
        version=image.c.version + 1,
    )
)
