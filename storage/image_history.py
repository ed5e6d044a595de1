"""The history of an image: its change sets, newest first, and what it takes to take one of them back."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Literal

from msgspec import Struct
from sqlalchemy import Connection, Row, func, select

from fairyring.storage.db.schema import annotation, change_set, edit, prediction, run, status_change
from fairyring.storage.images import get_image
from fairyring.storage.ledger import chunks, stored_annotations
from fairyring.storage.records import Annotation, Cap, GivenVerdict, Status
from fairyring.storage.verdicts import verdicts_by_change_set

MOST_TRIED = 200
"""Of how many change sets it is looked up whether they can be taken back."""
Way = Literal["undo", "redo"]
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


class Return(Struct, frozen=True, kw_only=True):
    """A cap as it is now and as it was before a change set."""

    annotation: Annotation
    cap: Cap | None
    """None where nobody had made it yet."""
    deleted: bool = False


class Reversal(Struct, frozen=True, kw_only=True):
    """What it takes to take a change set back."""

    id: str
    made_at: str
    returns: list[Return]
    """The caps that are as the change set left them."""
    changed_since: int
    """How many others there are."""
    status: tuple[Status, Status] | None
    """The status as the change set left it, if it is so still, and as it was before."""


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
    statuses, verdicts = _statuses(connection, numbers), verdicts_by_change_set(connection, numbers)
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


def reversal_of(connection: Connection, image_id: int, number: int) -> Reversal | None:
    """What it takes to take a change set of this image back; None where there is no such."""
    named = change_set.c.sequence == number, change_set.c.image == image_id
    row = connection.execute(select(change_set).where(*named)).first()
    return None if row is None else _reversal(connection, row)


def next_reversal(connection: Connection, image_id: int, *, user: str, way: Way) -> Reversal | None:
    """What it takes to undo the last thing that a person did to an image, or to redo what they undid last.

    What was taken back can be done again also after other caps were changed. Of a change set whose caps have
    been changed since, by whomever, nothing is left; the one before it is next.
    """
    statement = (
        select(change_set)
        .where(change_set.c.image == image_id, change_set.c.user == user)
        .order_by(change_set.c.sequence)
    )
    done, undone = _stacks(list(connection.execute(statement)))
    for row in (done if way == "undo" else undone)[: -MOST_TRIED - 1 : -1]:
        found = _reversal(connection, row)
        if found.returns or found.status:
            return found
    return None


def _stacks(rows: Sequence[Row]) -> tuple[list[Row], list[Row]]:
    """What can be undone and what can be redone, the last one last, after these change sets of a person."""
    done: dict[str, Row] = {}
    undone: dict[str, Row] = {}
    for row in rows:
        if row.takes_back is None:
            done[row.id] = row
        elif done.pop(row.takes_back, None) is not None:
            undone[row.id] = row
        else:
            undone.pop(row.takes_back, None)
            done[row.id] = row
    return list(done.values()), list(undone.values())


def _reversal(connection: Connection, row: Row) -> Reversal:
    first: dict[str, Row] = {}
    after: dict[str, Cap | None] = {}
    edits = select(edit).where(edit.c.change_set == row.sequence).order_by(edit.c.sequence)
    for each in connection.execute(edits):
        first.setdefault(each.annotation, each)
        after[each.annotation] = each.after
    now = stored_annotations(connection, first)
    left = [uid for uid in first if after[uid] == (None if now[uid].deleted else now[uid].cap)]
    left = [uid for uid in left if first[uid].before != after[uid] or first[uid].revision == 1]
    status = _statuses(connection, [row.sequence], said=True).get(row.sequence)
    holds = status is not None and get_image(connection, row.image).status == status[1]
    return Reversal(
        id=row.id,
        made_at=row.made_at,
        returns=_returns(connection, now, [first[uid] for uid in left]),
        changed_since=len(first) - len(left),
        status=(status[1], status[0]) if status is not None and holds else None,
    )


def _returns(connection: Connection, now: Mapping[str, Annotation], firsts: Sequence[Row]) -> list[Return]:
    gone = {row.annotation: row.revision for row in firsts if row.before is None and row.revision > 1}
    then = _caps_deleted_before(connection, gone)
    return [
        Return(
            annotation=now[row.annotation],
            cap=then.get(row.annotation, row.before),
            deleted=row.annotation in gone,
        )
        for row in firsts
    ]


def _caps_deleted_before(connection: Connection, revisions: Mapping[str, int]) -> dict[str, Cap]:
    """What annotations were when they were deleted, before they were brought back at these revisions."""
    caps: dict[str, Cap] = {}
    for uids in chunks(revisions):
        told = edit.c.annotation.in_(uids), edit.c.after.is_not(None)
        columns = select(edit.c.annotation, edit.c.revision, edit.c.after)
        for row in connection.execute(columns.where(*told).order_by(edit.c.sequence)):
            if row.revision < revisions[row.annotation]:
                caps[row.annotation] = row.after
    return caps


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


def _statuses(
    connection: Connection, numbers: Sequence[int], *, said: bool = False
) -> dict[int, tuple[Status, Status]]:
    """The status before and after each of these change sets that changed it; only what people ``said``."""
    statement = select(status_change).where(status_change.c.change_set.in_(numbers))
    if said:
        statement = statement.where(status_change.c.id.is_not(None))
    found = connection.execute(statement.order_by(status_change.c.sequence))
    return {row.change_set: (row.before, row.after) for row in found}
