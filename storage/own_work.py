"""Whose work an image is: nobody approves their own, unless the project says so.

An image is labelled until somebody first says that it is annotated; that is the work of all who did it.
After that, what somebody changes is their own until another person has looked at it.
"""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import Connection, func, select

from fairyring.model.errors import FairyringError
from fairyring.storage.cap_validity import check_cap
from fairyring.storage.change_sets import is_edit_of
from fairyring.storage.db.rows import AnySelect, require_image
from fairyring.storage.db.schema import annotation, change_set, edit, prediction, run, status_change, verdict
from fairyring.storage.errors import StoreError
from fairyring.storage.ledger import stored_annotations
from fairyring.storage.queues import DECIDED
from fairyring.storage.records import IMPORT, Cap, Mark, Outline
from fairyring.storage.rules import rules_of

ALLOW = "or let the project allow it, by “Approve own work” among its rules or fairyring rules --approve-own."
REMEDY = f"Somebody else has to; {ALLOW}"
UNSEEN = f"Send it back for somebody to say that it is annotated, or have somebody else approve it; {ALLOW}"


def require_work_of_others(connection: Connection, image_id: int, *, user: str) -> None:
    """Raises StoreError where an image is the work of ``user`` and the project wants others to approve it."""
    if rules_of(connection).approve_own:
        return
    name = require_image(connection, image_id).file_name
    if user in workers_on(connection, image_id):
        raise StoreError(f"You have labelled {name}, so you cannot approve it. {REMEDY}")
    if has_unseen_changes(connection, image_id, user=user):
        told = f"You have changed caps of {name} and nobody else has looked at it since"
        raise StoreError(f"{told}, so you cannot approve it. {UNSEEN}")


def require_cap_of_others(connection: Connection, uid: str, *, user: str) -> None:
    """The same of a cap, which is the work of whoever changed it last."""
    editor = connection.execute(
        select(annotation.c.edited_by).where(annotation.c.uid == uid)
    ).scalar_one_or_none()
    if editor == user and not rules_of(connection).approve_own:
        raise StoreError(f"You have drawn or changed this cap, so you cannot approve it. {REMEDY}")


def workers_on(connection: Connection, image_id: int) -> set[str]:
    """Who labelled an image: who changed caps until it was first called annotated, and who called it so.

    What was taken back is nobody's work.
    """
    calls = connection.execute(_calls(image_id)).all()
    worked = select(edit.c.user, edit.c.change_set).where(is_edit_of(image_id)).distinct()
    if calls:
        worked = worked.where(edit.c.change_set < calls[0].change_set)
    standing = _standing(connection, image_id)
    workers = {row.user for row in connection.execute(worked) if row.change_set in standing}
    return (workers | {call.user for call in calls}) - {IMPORT}


def has_unseen_changes(connection: Connection, image_id: int, *, user: str) -> bool:
    """Whether a person drew what stands on an image, and nobody else has looked at that since.

    Others have looked at an image who give a verdict on it or call it annotated. To take what a network said,
    or to delete a cap, is no drawing, except on an image that was rejected or sent back: to work on that is
    labelling.
    """
    seen = _seen_by_others(connection, image_id, user=user)
    given_back = _given_back(connection, image_id)
    changes = _changes(connection, image_id, user=user, after=seen)
    now = stored_annotations(connection, changes)
    for uid, change in changes.items():
        drawn = None if now[uid].deleted else _geometry(now[uid].cap)
        if drawn == change.before:
            continue
        if given_back is not None and change.last > given_back:
            return True
        if drawn is not None and not _is_said_by_network(connection, image_id, drawn):
            return True
    return False


@dataclass
class _Change:
    """What one person did to a cap."""

    before: tuple[Outline, Mark | None] | None
    """The geometry that it had; None where there was no cap."""
    last: int
    """The number of their last change set of it."""


def _changes(connection: Connection, image_id: int, *, user: str, after: int) -> dict[str, _Change]:
    """What somebody did to caps that are theirs now, since a change set, by uid."""
    made = connection.execute(
        select(edit.c.annotation, edit.c.before, edit.c.change_set)
        .join(annotation, annotation.c.uid == edit.c.annotation)
        .where(
            is_edit_of(image_id),
            edit.c.user == user,
            edit.c.change_set > after,
            annotation.c.edited_by == user,
        )
        .order_by(edit.c.sequence)
    )
    found: dict[str, _Change] = {}
    for row in made:
        before = None if row.before is None else _geometry(row.before)
        found.setdefault(row.annotation, _Change(before, 0)).last = row.change_set
    return found


def _geometry(cap: Cap) -> tuple[Outline, Mark | None]:
    return cap.visible, cap.mark


def _is_said_by_network(connection: Connection, image_id: int, geometry: tuple[Outline, Mark | None]) -> bool:
    """Whether a cap is a prediction as it is, or as it was repaired when somebody took it.

    With a mark it is one where a second annotator placed that mark.
    """
    visible, mark = geometry
    asked = (
        select(prediction.c.visible, prediction.c.whole, run.c.kind)
        .join(run, run.c.id == prediction.c.run)
        .where(prediction.c.image == image_id)
    )
    said = [
        each.visible
        for each in connection.execute(asked)
        if mark is None or (each.kind == "second" and each.whole == mark)
    ]
    if visible in said:
        return True
    photo = require_image(connection, image_id)
    return any(visible == _repaired(each, width=photo.width, height=photo.height) for each in said)


def _repaired(outline: Outline, *, width: int, height: int) -> Outline | None:
    try:
        return check_cap(Cap(visible=outline), width=width, height=height).visible
    except FairyringError:
        return None


def _seen_by_others(connection: Connection, image_id: int, *, user: str) -> int:
    """The last change set in which another person spoke of the image as a whole; 0 where none did."""
    judged = select(func.max(verdict.c.change_set)).where(
        verdict.c.image == image_id,
        verdict.c.annotation.is_(None),
        verdict.c.says.in_(DECIDED),
        verdict.c.user != user,
    )
    calls = [call.change_set for call in connection.execute(_calls(image_id)) if call.user != user]
    return max(connection.execute(judged).scalar_one() or 0, *calls, 0)


def _given_back(connection: Connection, image_id: int) -> int | None:
    """The change set that rejected an image or sent it back; None where that is not the last thing said."""
    last = connection.execute(
        select(verdict.c.says, verdict.c.change_set)
        .where(verdict.c.image == image_id, verdict.c.annotation.is_(None), verdict.c.says != "comment")
        .order_by(verdict.c.sequence.desc())
        .limit(1)
    ).first()
    return last.change_set if last is not None and last.says in ("rejected", "sent_back") else None


def _standing(connection: Connection, image_id: int) -> set[int]:
    """The change sets of an image that do not take back another one and are not taken back themselves."""
    sets = select(change_set.c.sequence, change_set.c.id, change_set.c.takes_back)
    rows = connection.execute(sets.where(change_set.c.image == image_id).order_by(change_set.c.sequence))
    standing: set[int] = set()
    begun: dict[str, int] = {}
    for row in rows:
        taken_back = begun.get(row.takes_back) if row.takes_back else None
        begun[row.id] = row.sequence if taken_back is None else taken_back
        standing ^= {begun[row.id]}
    return standing


def _calls(image_id: int) -> AnySelect:
    """The times at which a person called an image annotated, undoing aside, the first one first."""
    return (
        select(status_change.c.user, status_change.c.change_set)
        .join(change_set, change_set.c.sequence == status_change.c.change_set)
        .where(
            status_change.c.image == image_id,
            status_change.c.before == "new",
            status_change.c.after == "annotated",
            status_change.c.id.is_not(None),
            change_set.c.takes_back.is_(None),
        )
        .order_by(status_change.c.sequence)
    )
