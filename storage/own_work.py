"""Whose work an image is: nobody approves their own, unless the project says so.

An image is labelled until somebody first says that it is annotated. Whoever corrects a cap after that reviews
the work of others and may approve it, unless they call it annotated themselves.
"""

from __future__ import annotations

from sqlalchemy import Connection, select

from fairyring.storage.db.rows import AnySelect
from fairyring.storage.db.schema import annotation, change_set, edit, status_change
from fairyring.storage.errors import StoreError
from fairyring.storage.records import IMPORT
from fairyring.storage.rules import rules_of

REMEDY = "Somebody else has to; or let the project allow it: fairyring rules PROJECT --approve-own."


def require_work_of_others(connection: Connection, image_id: int, *, user: str) -> None:
    """Raises StoreError where an image is the work of ``user`` and the project wants others to approve it."""
    if user in workers_on(connection, image_id) and not rules_of(connection).approve_own:
        raise StoreError(f"You have labelled this image, so you cannot approve it. {REMEDY}")


def require_cap_of_others(connection: Connection, uid: str, *, user: str) -> None:
    """The same of a cap, which is the work of whoever changed it last."""
    editor = connection.execute(
        select(annotation.c.edited_by).where(annotation.c.uid == uid)
    ).scalar_one_or_none()
    if editor == user and not rules_of(connection).approve_own:
        raise StoreError(f"You have drawn or changed this cap, so you cannot approve it. {REMEDY}")


def workers_on(connection: Connection, image_id: int) -> set[str]:
    """Who labelled an image: who changed caps until it was first called annotated, and who called it so."""
    calls = connection.execute(_calls(image_id)).all()
    worked = select(edit.c.user).where(edit.c.image == image_id).distinct()
    if calls:
        worked = worked.where(edit.c.change_set < calls[0].change_set)
    workers = set(connection.execute(worked).scalars()) | {call.user for call in calls}
    return workers - {IMPORT}


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
