"""The history of an image: its change sets, newest first."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Literal

from msgspec import Struct
from sqlalchemy import Connection, Row, func, select

from fairyring.storage.db.schema import annotation, change_set, edit, prediction, run
from fairyring.storage.records import Cap, GivenVerdict, Status
from fairyring.storage.statuses import statuses_by_change_set
from fairyring.storage.verdicts import verdicts_by_change_set

Kind = Literal["done", "undone", "redone"]
"""Whether a change set was done for the first time, takes one back, or takes back such a taking back."""


class ChangeSet(Struct, frozen=True, kw_only=True):
    """One change set as the history lists it."""

    number: int
    user: str
    made_at: str
    """UTC, ISO 8601."""
    made: int = 0
    """Caps that were there for the first time."""
    changed: int = 0
    deleted: int = 0
    turned_down: int = 0
    """Predictions that were turned down."""
    brought_back: int = 0
    status: tuple[Status, Status] | None = None
    """The status before and after, where it was changed."""
    verdict: GivenVerdict | None = None
    """What was said of the image or of a cap."""
    first: tuple[str, Cap | None, Cap | None] | None = None
    """The first of its caps: uid, before and after."""
    second: str | None = None
    """The second annotator's version that this one was made from; None where it was not."""
    outline_of: str | None = None
    """The run in which the first of its caps has the very outline that it was given; None where none has."""
    taken_back: bool = False
    """Another one has taken it back."""
    kind: Kind = "done"


class ChangeSetPage(Struct, frozen=True, kw_only=True):
    """A page of the history, and how many change sets there are in all."""

    change_sets: list[ChangeSet]
    total: int


def list_change_sets(
    connection: Connection, image_id: int, *, offset: int = 0, limit: int = 10
) -> ChangeSetPage:
    """A page of the history of an image, newest first."""
    which = change_set.c.image == image_id
    total = connection.execute(select(func.count()).select_from(change_set).where(which)).scalar_one()
    newest = select(change_set).where(which).order_by(change_set.c.sequence.desc())
    rows = list(connection.execute(newest.offset(offset).limit(limit)))
    numbers = [row.sequence for row in rows]
    takes_back = _takes_back(connection, image_id)
    effects, firsts = _effects(connection, numbers), _firsts(connection, numbers)
    statuses, verdicts = (
        statuses_by_change_set(connection, numbers),
        verdicts_by_change_set(connection, numbers),
    )
    seconds = _second_versions(connection, [uid for uid, _, _ in firsts.values()])
    outlines_of = _outlines_of(connection, image_id, firsts)
    return ChangeSetPage(
        change_sets=[
            ChangeSet(
                number=row.sequence,
                user=row.user,
                made_at=row.made_at,
                **effects[row.sequence],
                status=statuses.get(row.sequence),
                verdict=verdicts.get(row.sequence),
                first=firsts.get(row.sequence),
                second=seconds.get(firsts[row.sequence][0]) if row.sequence in firsts else None,
                outline_of=outlines_of.get(row.sequence),
                taken_back=row.id in takes_back.values(),
                kind=_kind(row.id, takes_back),
            )
            for row in rows
        ],
        total=total,
    )


def _takes_back(connection: Connection, image_id: int) -> dict[str, str]:
    """Which change set of an image takes back which."""
    which = change_set.c.image == image_id, change_set.c.takes_back.is_not(None)
    return {
        row.id: row.takes_back
        for row in connection.execute(select(change_set.c.id, change_set.c.takes_back).where(*which))
    }


def _kind(change: str, takes_back: Mapping[str, str]) -> Kind:
    kind: Kind = "done"
    left = len(takes_back)
    while (taken := takes_back.get(change)) is not None and left > 0:
        change, left = taken, left - 1
        kind = "redone" if kind == "undone" else "undone"
    return kind


def _effects(connection: Connection, numbers: Sequence[int]) -> dict[int, dict[str, int]]:
    """What became of how many caps, by change set."""
    columns = (edit.c.change_set, edit.c.annotation, edit.c.revision)
    there = (edit.c.before.is_not(None).label("was"), edit.c.after.is_not(None).label("is_now"))
    statement = select(*columns, *there).where(edit.c.change_set.in_(numbers)).order_by(edit.c.sequence)
    first: dict[tuple[int, str], Row] = {}
    last: dict[tuple[int, str], Row] = {}
    for row in connection.execute(statement):
        first.setdefault((row.change_set, row.annotation), row)
        last[row.change_set, row.annotation] = row
    effects: dict[int, dict[str, int]] = {number: defaultdict(int) for number in numbers}
    for key, row in first.items():
        what = _effect(was=bool(row.was), new=row.revision == 1, is_now=bool(last[key].is_now))
        effects[row.change_set][what] += 1
    return effects


def _effect(*, was: bool, new: bool, is_now: bool) -> str:
    if was:
        return "changed" if is_now else "deleted"
    if is_now:
        return "made" if new else "brought_back"
    return "turned_down"


def _firsts(connection: Connection, numbers: Sequence[int]) -> dict[int, tuple[str, Cap | None, Cap | None]]:
    """The first edit of each of these change sets: uid, before and after."""
    lowest = (
        select(func.min(edit.c.sequence)).where(edit.c.change_set.in_(numbers)).group_by(edit.c.change_set)
    )
    found = connection.execute(select(edit).where(edit.c.sequence.in_(lowest)))
    return {row.change_set: (row.annotation, row.before, row.after) for row in found}


def _second_versions(connection: Connection, uids: Sequence[str]) -> dict[str, str]:
    """Which of these annotations started from a cap of a second annotator's, and what theirs is called."""
    found = connection.execute(
        select(annotation.c.uid, run.c.name)
        .join(prediction, prediction.c.id == annotation.c.prediction)
        .join(run, run.c.id == prediction.c.run)
        .where(annotation.c.uid.in_(uids), run.c.kind == "second")
    )
    return {row.uid: row.name for row in found}


def _outlines_of(
    connection: Connection, image_id: int, firsts: Mapping[int, tuple[str, Cap | None, Cap | None]]
) -> dict[int, str]:
    """By change set: the latest run that has the outline which it gave to a cap that had another."""
    given = {
        number: after.visible
        for number, (_, before, after) in firsts.items()
        if before and after and after.visible and before.visible != after.visible
    }
    found = connection.execute(
        select(prediction.c.visible, run.c.name)
        .join(run, run.c.id == prediction.c.run)
        .where(prediction.c.image == image_id, prediction.c.visible.in_(list(given.values())))
        .order_by(run.c.id)
    ).all()
    return {number: row.name for number, visible in given.items() for row in found if row.visible == visible}
