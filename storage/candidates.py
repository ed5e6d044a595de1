"""The images that wait for a reviewer, with what says which of them is to be looked at first."""

from __future__ import annotations

from msgspec import Struct
from sqlalchemy import ColumnElement, Connection, and_, exists, func, or_, select

from fairyring.storage.db.comparison_schema import comparison
from fairyring.storage.db.schema import change_set, edit, image, prediction, status_change
from fairyring.storage.records import IMPORT


class Candidate(Struct, frozen=True, kw_only=True):
    """An image that somebody worked on and nobody has approved as it is now; None for what is not known."""

    image: int
    file_name: str
    excess: float | None
    """Mean CDR less the floor of the marks, percent."""
    iou: float | None
    """Mean IoU of the outlines with what was predicted."""
    missed: int
    extra: int
    doubt: float
    """How many of its predictions are expected to be wrong, as scores are probabilities."""
    compared: bool
    """What was compared with the predictions is as it is now."""
    reopened: bool
    """It was approved, and edited since."""


def candidates(
    connection: Connection, *, annotator: str | None = None, unfinished: bool = False
) -> list[Candidate]:
    """The images that wait for a reviewer, by name.

    Args:
        connection: to read by.
        annotator: only images of which this person edited a cap; None for all.
        unfinished: also images with caps that nobody has called annotated.
    """
    doubts = (
        select(prediction.c.image, prediction.c.run, func.sum(1 - prediction.c.score).label("doubt"))
        .group_by(prediction.c.image, prediction.c.run)
        .subquery()
    )
    statement = (
        select(image.c.id, image.c.file_name, image.c.version.label("now"), doubts.c.doubt, comparison)
        .outerjoin(comparison, and_(comparison.c.image == image.c.id, comparison.c.run == image.c.run))
        .outerjoin(doubts, and_(doubts.c.image == image.c.id, doubts.c.run == image.c.run))
        .where(_condition(annotator, unfinished=unfinished))
        .order_by(image.c.sort_name, image.c.id)
    )
    reopened = _reopened(connection)
    return [
        Candidate(
            image=row.id,
            file_name=row.file_name,
            excess=None if row.cdr_mean is None else row.cdr_mean - (row.floor_mean or 0.0),
            iou=row.iou_mean,
            missed=row.missed or 0,
            extra=row.extra or 0,
            doubt=row.doubt or 0.0,
            compared=row.version == row.now,
            reopened=row.id in reopened,
        )
        for row in connection.execute(statement)
    ]


def count_candidates(
    connection: Connection,
    *,
    annotator: str | None = None,
    unfinished: bool = False,
    reopened: bool = False,
) -> int:
    """How many of them there are; with ``reopened`` those alone that were edited since they were approved."""
    asked = select(image.c.id).where(_condition(annotator, unfinished=unfinished))
    found = set(connection.execute(asked).scalars())
    return len(found & _reopened(connection) if reopened else found)


def _condition(annotator: str | None, *, unfinished: bool) -> ColumnElement[bool]:
    worked_on = and_(image.c.status == "new", image.c.caps > 0)
    waiting = image.c.status == "annotated"
    condition = or_(waiting, worked_on) if unfinished else waiting
    if annotator is None:
        return condition
    has_edits = exists().where(edit.c.change_set == change_set.c.sequence)
    theirs = select(change_set.c.image).where(change_set.c.user == annotator, has_edits)
    return and_(condition, image.c.id.in_(theirs))


def count_waiting(connection: Connection) -> int:
    """How many images wait for a reviewer."""
    waiting = select(func.count()).select_from(image).where(image.c.status == "annotated")
    return connection.execute(waiting).scalar_one()


def people(connection: Connection) -> list[str]:
    """Who changed anything, by name; imports aside."""
    # Of change sets, as edits hold whole caps and take long to read through.
    return sorted(set(connection.execute(select(change_set.c.user).distinct()).scalars()) - {IMPORT})


def _reopened(connection: Connection) -> set[int]:
    """The images that an edit has taken their approval from, and of which nobody has spoken since."""
    last = select(func.max(status_change.c.sequence)).group_by(status_change.c.image)
    found = select(status_change.c.image).where(
        status_change.c.sequence.in_(last),
        status_change.c.id.is_(None),
        status_change.c.before == "approved",
    )
    return set(connection.execute(found).scalars())
