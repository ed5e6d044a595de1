"""What reviewers said of images and caps, who and when: a history of which nothing is ever changed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from hashlib import sha256
from typing import Any

from msgspec import json
from sqlalchemy import ColumnElement, Connection, Row, func, insert, select

from fairyring.storage.db.clock import now
from fairyring.storage.db.schema import verdict
from fairyring.storage.errors import StoreError
from fairyring.storage.records import GivenVerdict, Says, Verdict


def enter_verdict(
    connection: Connection, said: Verdict, *, revision: int | None, change_set: int | None, user: str
) -> None:
    """Adds a verdict to the history, whatever it says.

    Args:
        connection: within ``Project.write``.
        said: the verdict.
        revision: of the cap that it is about; None for an image.
        change_set: the number of the change set it belongs to.
        user: who gives it.
    """
    connection.execute(
        insert(verdict).values(
            id=said.id,
            digest=_digest_of(said),
            image=said.image,
            annotation=said.annotation,
            revision=revision,
            says=said.says,
            words=said.words,
            user=user,
            made_at=now(),
            change_set=change_set,
        )
    )


def was_given_before(connection: Connection, said: Verdict) -> bool:
    """Whether this verdict is in the history. Raises StoreError where another one has its number."""
    known = connection.execute(select(verdict.c.digest).where(verdict.c.id == said.id)).scalar_one_or_none()
    if known is not None and known != _digest_of(said):
        raise StoreError("Another verdict has this number; reload the page.")
    return known is not None


def verdicts_of(connection: Connection, image_id: int) -> list[GivenVerdict]:
    """All that was said of an image and its caps, the first one first."""
    return _found(connection, verdict.c.image == image_id)


def all_verdicts(connection: Connection) -> list[GivenVerdict]:
    """All that was said of all images, the first one first."""
    return _found(connection, verdict.c.sequence > 0)


def verdicts_by_change_set(connection: Connection, numbers: Sequence[int]) -> dict[int, GivenVerdict]:
    """What was said in each of these change sets in which anything was."""
    rows = connection.execute(select(verdict).where(verdict.c.change_set.in_(numbers)))
    return {row.change_set: _given(row) for row in rows}


def latest_verdict(connection: Connection, image_id: int) -> Says | None:
    """What was last said of an image itself, comments aside; None where nothing was."""
    last = last_said(connection, image_id, None)
    return None if last is None else last.says


def last_said(connection: Connection, image_id: int, annotation: str | None) -> GivenVerdict | None:
    """The last verdict on an image itself or on a cap of it, comments aside; None where there is none."""
    about = verdict.c.annotation.is_(None) if annotation is None else verdict.c.annotation == annotation
    which = verdict.c.image == image_id, about, verdict.c.says != "comment"
    row = connection.execute(
        select(verdict).where(*which).order_by(verdict.c.sequence.desc()).limit(1)
    ).first()
    return None if row is None else _given(row)


def given_back(connection: Connection, image_ids: Iterable[int]) -> dict[int, Says]:
    """Those of these images that were last rejected or sent back, with which of the two it was."""
    last = (
        select(func.max(verdict.c.sequence))
        .where(
            verdict.c.image.in_(list(image_ids)),
            verdict.c.annotation.is_(None),
            verdict.c.says != "comment",
        )
        .group_by(verdict.c.image)
    )
    asked = select(verdict.c.image, verdict.c.says).where(
        verdict.c.sequence.in_(last), verdict.c.says.in_(("rejected", "sent_back"))
    )
    return {row.image: row.says for row in connection.execute(asked)}


def _found(connection: Connection, which: ColumnElement[bool]) -> list[GivenVerdict]:
    rows = connection.execute(select(verdict).where(which).order_by(verdict.c.sequence))
    return [_given(row) for row in rows]


def _given(row: Row[Any]) -> GivenVerdict:
    return GivenVerdict(
        number=row.sequence,
        image=row.image,
        annotation=row.annotation,
        revision=row.revision,
        says=row.says,
        words=row.words,
        user=row.user,
        made_at=row.made_at,
    )


def _digest_of(said: Verdict) -> str:
    return sha256(json.encode(said)).hexdigest()
