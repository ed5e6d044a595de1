"""What it takes to take back a change set of an image, by whomever, or what one person did last."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

from msgspec import Struct
from sqlalchemy import Connection, Row, select

from fairyring.storage.db.schema import change_set, edit
from fairyring.storage.images import get_image
from fairyring.storage.ledger import chunks, stored_annotations
from fairyring.storage.records import Annotation, Cap, Says, Status
from fairyring.storage.statuses import statuses_by_change_set
from fairyring.storage.verdicts import last_said, verdicts_by_change_set

MOST_TRIED = 200
"""Of how many change sets it is looked up whether they can be taken back."""
Way = Literal["undo", "redo"]


class Return(Struct, frozen=True, kw_only=True):
    """A cap as it is now and as it was before a change set."""

    annotation: Annotation
    cap: Cap | None
    """None where nobody had made it yet."""
    deleted: bool = False


class VerdictToWithdraw(Struct, frozen=True, kw_only=True):
    """What somebody said of a cap, or of the image where ``annotation`` is None."""

    annotation: str | None
    says: Says
    words: str


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
    verdict: VerdictToWithdraw | None = None
    """What was said in it without another status, if nothing was said since; to be withdrawn."""


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
        if found.returns or found.status or found.verdict:
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
    status = statuses_by_change_set(connection, [row.sequence], said=True).get(row.sequence)
    holds = status is not None and get_image(connection, row.image).status == status[1]
    return Reversal(
        id=row.id,
        made_at=row.made_at,
        returns=_returns(connection, now, [first[uid] for uid in left]),
        changed_since=len(first) - len(left),
        status=(status[1], status[0]) if status is not None and holds else None,
        verdict=None if status is not None else _last_verdict(connection, row),
    )


def _last_verdict(connection: Connection, row: Row) -> VerdictToWithdraw | None:
    """What was said in a change set, where nothing was said of the same cap or image since."""
    said = verdicts_by_change_set(connection, [row.sequence]).get(row.sequence)
    if said is None or said.says in ("comment", "withdrawn"):
        return None
    last = last_said(connection, row.image, said.annotation)
    if last is None or last.number != said.number:
        return None
    cap = said.annotation
    if cap is not None and stored_annotations(connection, [cap])[cap].deleted:
        return None
    return VerdictToWithdraw(annotation=said.annotation, says=said.says, words=said.words)


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
