"""Tells reviewers what has been written of what they said of images."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from sqlalchemy import Connection

from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.protocol import Edits
from fairyring.app.review.queueing import standing_of
from fairyring.storage.candidates import count_waiting
from fairyring.storage.images import get_image
from fairyring.storage.queues import decisions_in, queue_of
from fairyring.storage.records import Outcome, Says, StatusEdit, StatusStored, Verdict

SAID: dict[Says, str] = {
    "approved": "Approved {}",
    "rejected": "Rejected {}",
    "sent_back": "Sent {} back",
    "comment": "Commented on {}",
}
AGAIN = {"new": "to do", "annotated": "annotated", "approved": "approved"}


async def confirm(
    workspace: Workspace, session: Session, message: Edits, outcomes: Sequence[Outcome]
) -> None:
    """Says what was written of the verdicts and approvals of a message; refusals tell of themselves."""
    stored = {each.edit for each in outcomes if isinstance(each, StatusStored)}
    for made in [*message.statuses, *message.verdicts]:
        told = _told(made) if made.id in stored else None
        if told is not None:
            find = partial(_find, image_id=made.image, user=session.user)
            name, standing = await workspace.read(find)
            session.notify(f"{told.format(name)} {standing}".strip(), undo=_undone_by(made))


def _told(made: StatusEdit | Verdict) -> str | None:
    """The sentence, with a place for the name of the image; None where the page itself shows enough."""
    if isinstance(made, StatusEdit):
        if made.takes_back:
            return f"Taken back: {{}} is {AGAIN[made.after]} again."
        return "Approved {}." if made.after == "approved" else None
    if made.annotation is not None and made.says == "approved":
        return None
    about = "{}" if made.annotation is None else "a cap of {}"
    said = SAID[made.says].format(about)
    words = made.words.strip().replace("{", "{{").replace("}", "}}")
    return f"{said}: “{words}”." if words else f"{said}."


def _undone_by(made: StatusEdit | Verdict) -> int | None:
    """The image whose status can be taken back, where it may have changed for this."""
    if isinstance(made, StatusEdit):
        return None if made.takes_back else made.image
    return made.image if made.annotation is None and made.says != "comment" else None


def _find(connection: Connection, *, image_id: int, user: str) -> tuple[str, str]:
    """The name of an image, and how far the queue is that it is in, or how many images wait."""
    name, queue = get_image(connection, image_id).file_name, queue_of(connection, user)
    if queue is None or image_id not in queue.images:
        waiting = count_waiting(connection)
        return name, f"{waiting} to review." if waiting else "Nothing else waits for a review."
    standing = standing_of(queue, decisions_in(connection, queue))
    return name, f"{standing.done} of {standing.of} done."
