"""What people say of images: changes of status are journalled as edits are, and follow edits of caps."""

from __future__ import annotations

from collections.abc import Sequence
from hashlib import sha256
from uuid import uuid4

from msgspec import json
from sqlalchemy import Connection, insert, select, update

from fairyring.model.errors import FairyringError
from fairyring.storage.cap_validity import check_name
from fairyring.storage.change_sets import ChangeSets, check_change_set, is_edit_of
from fairyring.storage.db.clock import now
from fairyring.storage.db.rows import image_of, require_image
from fairyring.storage.db.schema import edit, image, status_change
from fairyring.storage.errors import StoreError
from fairyring.storage.ledger import stored_annotations
from fairyring.storage.own_work import require_work_of_others
from fairyring.storage.records import (
    STATUSES,
    Cap,
    Image,
    Outcome,
    Refused,
    Says,
    Status,
    StatusEdit,
    StatusStored,
    Verdict,
)
from fairyring.storage.verdicts import enter_verdict, latest_verdict


def set_status(connection: Connection, image_id: int, status: Status, *, user: str) -> Image:
    """Sets the status, whatever it was, and journals who did it and when; returns the image as it is now.

    Raises:
        StoreError: the project has no such image, or there is no such status.
    """
    check_name(user, "name of a user")
    if status not in STATUSES:
        raise StoreError(f"The status of an image is one of {', '.join(STATUSES)}.")
    before = require_image(connection, image_id).status
    if before != status:
        made = StatusEdit(id=uuid4().hex, image=image_id, before=before, after=status)
        _say(connection, made, ChangeSets(connection, user=user), user=user)
    return image_of(require_image(connection, image_id))


def commit_status(connection: Connection, made: StatusEdit, sets: ChangeSets, *, user: str) -> Outcome:
    """Stores a change of status made on the status as it is; one sent before is accepted again."""
    try:
        check_name(made.id, "number of an edit")
        check_change_set(made)
        photo = require_image(connection, made.image)
        if not _was_sent_before(connection, made):
            if photo.status != made.before:
                raise StoreError(_overtaken(connection, image_of(photo)))
            if made.after == "approved":
                require_work_of_others(connection, made.image, user=user)
            _say(connection, made, sets, user=user)
    except FairyringError as error:
        return Refused(edit=made.id, reason=str(error))
    return StatusStored(edit=made.id, image=made.image, status=require_image(connection, made.image).status)


def follow_edits(connection: Connection, image_id: int, number: int, *, takes_back: bool, user: str) -> None:
    """Has the status follow edits of caps that a change set has just brought.

    What was approved is so no longer once any cap is another. It is again when taking back has made all caps
    what they were when it was approved.

    Args:
        connection: within ``Project.write``.
        image_id: whose caps were edited.
        number: of the change set.
        takes_back: whether it takes back another one.
        user: who made it.
    """
    status = require_image(connection, image_id).status
    if status == "approved":
        _enter(connection, image_id, before=status, after="annotated", number=number, user=user)
    elif takes_back and _is_as_approved(connection, image_id):
        _enter(connection, image_id, before=status, after="approved", number=number, user=user)


def statuses_by_change_set(
    connection: Connection, numbers: Sequence[int], *, said: bool = False
) -> dict[int, tuple[Status, Status]]:
    """The status before and after each of these change sets that changed it; only what people ``said``."""
    statement = select(status_change).where(status_change.c.change_set.in_(numbers))
    if said:
        statement = statement.where(status_change.c.id.is_not(None))
    found = connection.execute(statement.order_by(status_change.c.sequence))
    return {row.change_set: (row.before, row.after) for row in found}


def _is_as_approved(connection: Connection, image_id: int) -> bool:
    """Whether an edit reopened the image, nobody spoke of it since, and its caps are as before that edit."""
    last = connection.execute(
        select(status_change)
        .where(status_change.c.image == image_id)
        .order_by(status_change.c.sequence.desc())
        .limit(1)
    ).first()
    if last is None or last.id is not None or last.before != "approved":
        return False
    reopened = select(edit.c.sequence).where(edit.c.change_set == last.change_set).order_by(edit.c.sequence)
    first = connection.execute(reopened.limit(1)).scalar_one()
    since = (
        select(edit.c.annotation, edit.c.before)
        .where(edit.c.sequence >= first, is_edit_of(image_id))
        .order_by(edit.c.sequence)
    )
    approved: dict[str, Cap | None] = {}
    for row in connection.execute(since):
        approved.setdefault(row.annotation, row.before)
    now = stored_annotations(connection, approved)
    return approved == {uid: None if each.deleted else each.cap for uid, each in now.items()}


def _was_sent_before(connection: Connection, made: StatusEdit) -> bool:
    known = connection.execute(
        select(status_change.c.digest).where(status_change.c.id == made.id)
    ).scalar_one_or_none()
    if known is not None and known != _digest_of(made):
        raise StoreError("Another edit has this number; reload the page.")
    return known is not None


def _overtaken(connection: Connection, photo: Image) -> str:
    last = connection.execute(
        select(status_change.c.user)
        .where(status_change.c.image == photo.id)
        .order_by(status_change.c.sequence.desc())
        .limit(1)
    ).scalar_one_or_none()
    words = "to do" if photo.status == "new" else photo.status
    return f"{last or 'Somebody'} has set {photo.file_name} to “{words}” meanwhile; it stays so."


def _say(connection: Connection, made: StatusEdit, sets: ChangeSets, *, user: str) -> None:
    """Enters the status, and the verdict that it is."""
    record_status(connection, made, sets, user=user)
    if (says := _verdict_of(connection, made)) is not None:
        said = Verdict(id=f"status-{made.id}", image=made.image, says=says)
        number = sets.number_of(made, time=now())
        enter_verdict(connection, said, revision=None, change_set=number, user=user)


def _verdict_of(connection: Connection, made: StatusEdit) -> Says | None:
    """Setting an image to approved approves it; setting it to something else, or undoing, ends a verdict."""
    if made.after == "approved":
        return "approved"
    ended = ("approved", "rejected", "sent_back") if made.takes_back else ("approved",)
    return "withdrawn" if latest_verdict(connection, made.image) in ended else None


def record_status(connection: Connection, made: StatusEdit, sets: ChangeSets, *, user: str) -> None:
    """Enters a change of status in the history, and the status as it is now."""
    time = now()
    connection.execute(update(image).where(image.c.id == made.image).values(status=made.after))
    connection.execute(
        insert(status_change).values(
            id=made.id,
            digest=_digest_of(made),
            image=made.image,
            before=made.before,
            after=made.after,
            user=user,
            made_at=time,
            change_set=sets.number_of(made, time=time),
        )
    )


def _enter(
    connection: Connection, image_id: int, *, before: Status, after: Status, number: int, user: str
) -> None:
    """Journals a change of status that an edit of a cap has brought about: it has no number of its own."""
    connection.execute(update(image).where(image.c.id == image_id).values(status=after))
    values = {"image": image_id, "before": before, "after": after, "user": user, "made_at": now()}
    connection.execute(insert(status_change).values(**values, change_set=number))


def _digest_of(made: StatusEdit) -> str:
    return sha256(json.encode(made)).hexdigest()
