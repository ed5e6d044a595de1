"""Verdicts as they come in: checked, entered, and followed by the status of their image."""

from __future__ import annotations

from sqlalchemy import Connection, select

from fairyring.model.errors import FairyringError
from fairyring.storage.cap_validity import check_name
from fairyring.storage.change_sets import ChangeSets, check_change_set
from fairyring.storage.db.clock import now
from fairyring.storage.db.rows import require_image
from fairyring.storage.db.schema import annotation
from fairyring.storage.errors import StoreError
from fairyring.storage.own_work import require_cap_of_others, require_work_of_others
from fairyring.storage.records import Outcome, Refused, Says, Status, StatusEdit, StatusStored, Verdict
from fairyring.storage.statuses import record_status
from fairyring.storage.verdicts import enter_verdict, last_said, was_given_before

MOST_WORDS = 2000
"""Characters of a reason or a comment."""
NEED_WORDS: dict[Says, str] = {
    "rejected": "Say why it is rejected.",
    "sent_back": "Say what is to be done about it.",
    "comment": "A comment needs words.",
}
STATUS_AFTER: dict[Says, Status] = {"approved": "approved", "rejected": "new", "sent_back": "new"}
"""The status of an image of which this is said."""


def commit_verdict(connection: Connection, said: Verdict, sets: ChangeSets, *, user: str) -> Outcome:
    """Stores a verdict in the transaction of ``connection``; one sent before is accepted again.

    An image that is rejected or sent back is to do again, one that is approved is approved. A verdict on a
    cap leaves the status as it is.
    """
    try:
        check_name(said.id, "number of a verdict")
        check_change_set(said)
        require_image(connection, said.image)
        if not was_given_before(connection, said):
            _check(connection, said, user=user)
            if said.annotation is None:
                _judge_image(connection, said, sets, user=user)
            else:
                _judge_cap(connection, said, said.annotation, sets, user=user)
    except FairyringError as error:
        return Refused(edit=said.id, reason=str(error))
    return StatusStored(edit=said.id, image=said.image, status=require_image(connection, said.image).status)


def _check(connection: Connection, said: Verdict, *, user: str) -> None:
    if said.says in NEED_WORDS and not said.words.strip():
        raise StoreError(NEED_WORDS[said.says])
    if said.says == "withdrawn":
        _require_own_to_withdraw(connection, said, user=user)
    if len(said.words) > MOST_WORDS:
        raise StoreError(f"A comment has at most {MOST_WORDS} characters; this one has {len(said.words)}.")


def _require_own_to_withdraw(connection: Connection, said: Verdict, *, user: str) -> None:
    """An approval of an image, and what else has changed its status, is withdrawn by undoing that."""
    last = last_said(connection, said.image, said.annotation)
    if last is None or last.user != user or last.says == "withdrawn":
        raise StoreError("What you said is no longer what was said last of it, so it cannot be taken back.")
    if said.annotation is None and last.says == "approved":
        raise StoreError("An approval is withdrawn by setting another status, or by undoing it.")


def _judge_image(connection: Connection, said: Verdict, sets: ChangeSets, *, user: str) -> None:
    if said.says == "approved":
        require_work_of_others(connection, said.image, user=user)
    number = sets.number_of(said, time=now())
    enter_verdict(connection, said, revision=None, change_set=number, user=user)
    before: Status = require_image(connection, said.image).status
    after = STATUS_AFTER.get(said.says, before)
    if after != before:
        change = StatusEdit(
            id=f"verdict-{said.id}",
            image=said.image,
            before=before,
            after=after,
            change_set=said.change_set,
        )
        record_status(connection, change, sets, user=user)


def _judge_cap(connection: Connection, said: Verdict, uid: str, sets: ChangeSets, *, user: str) -> None:
    cap = connection.execute(
        select(annotation.c.revision).where(
            annotation.c.uid == uid, annotation.c.image == said.image, annotation.c.deleted == 0
        )
    ).first()
    if cap is None:
        raise StoreError("There is no such cap on this image any more; reload the image.")
    if said.says == "approved":
        require_cap_of_others(connection, uid, user=user)
    number = sets.number_of(said, time=now())
    enter_verdict(connection, said, revision=cap.revision, change_set=number, user=user)
