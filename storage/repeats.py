"""Caps that people are asked to mark again, and their second marks, which are kept apart from the labels."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from hashlib import sha256

from msgspec import Struct, structs
from sqlalchemy import Connection, insert, select

from fairyring.model.geometry.shapes import Circle, Polygon
from fairyring.storage.db.clock import now
from fairyring.storage.db.schema import annotation, edit, image, repeat
from fairyring.storage.errors import StoreError
from fairyring.storage.records import Cap, Mark, Repeat
from fairyring.storage.rules import rules_of

ANOTHER_DAY = timedelta(hours=16)
"""So old a mark is from another day: its cap may be shown as it was, else it is mirrored."""


class DueRepeat(Struct, frozen=True, kw_only=True):
    """A cap to be marked again."""

    annotation: str
    image: int
    mirrored: bool
    left: int
    """How many are due, with this one."""


def due_repeat(connection: Connection, *, user: str, besides: int | None = None) -> DueRepeat | None:
    """The next cap that somebody is to mark again; None where there is none.

    Which caps are asked for follows from the project's seed and their uids alone, so it is the same share of
    every kind of cap. Asked for once is whoever placed the mark.

    Args:
        connection: to read by.
        user: who is asked.
        besides: an image of which nothing is asked, as its marks are on screen.
    """
    rules = rules_of(connection)
    if not rules.repeat_share:
        return None
    done = select(repeat.c.annotation)
    found = connection.execute(
        select(annotation.c.uid, annotation.c.image, annotation.c.edited_at).where(
            annotation.c.edited_by == user,
            annotation.c.mark.is_not(None),
            annotation.c.deleted == 0,
            annotation.c.ignored == 0,
            annotation.c.uid.not_in(done),
        )
    )
    drawn = ((chance_of(row.uid, seed=rules.repeat_seed), row) for row in found)
    chosen = sorted((chance, row.uid, row) for chance, row in drawn if chance < rules.repeat_share)
    due = [row for _, _, row in chosen if row.image != besides and placed_mark(connection, row.uid, user)]
    if not due:
        return None
    first = due[0]
    return DueRepeat(
        annotation=first.uid,
        image=first.image,
        mirrored=_is_recent(first.edited_at) or chance_of(first.uid, seed=rules.repeat_seed + 1) < 0.5,
        left=len(due),
    )


def chance_of(uid: str, *, seed: int) -> float:
    """A number from 0 to 1 that is the same for this cap and seed every time, and evenly spread over caps."""
    return int.from_bytes(sha256(f"{seed} {uid}".encode()).digest()[:6], "big") / 2**48


def placed_mark(connection: Connection, uid: str, user: str) -> bool:
    """Whether the mark that a cap has now is of this person, and of a kind that is placed by hand.

    A mark that was gone for a while is of whoever placed it first, be it put back by somebody else.
    """
    edits = connection.execute(
        select(edit.c.before, edit.c.after, edit.c.user)
        .where(edit.c.annotation == uid)
        .order_by(edit.c.revision)
    )
    placed = [(_mark_of(each.before), _mark_of(each.after), each.user) for each in edits]
    mark = placed[-1][1] if placed else None
    placers = (by for before, after, by in placed if after == mark != before)
    return isinstance(mark, Circle | Polygon) and next(placers, None) == user


def _mark_of(cap: Cap | None) -> Mark | None:
    return None if cap is None else cap.mark


def store_repeat(connection: Connection, made: Repeat) -> None:
    """Keeps a second mark, within ``Project.write``; one sent before is kept once.

    Raises:
        StoreError: the cap has another mark by now, or was marked again before.
    """
    if connection.execute(select(repeat.c.id).where(repeat.c.id == made.id)).first() is not None:
        return
    cap = connection.execute(
        select(annotation.c.mark).where(annotation.c.uid == made.annotation, annotation.c.deleted == 0)
    ).first()
    if cap is None or cap.mark != made.first:
        raise StoreError("The mark of this cap is another one by now, so the second one says nothing of it.")
    if connection.execute(select(repeat.c.id).where(repeat.c.annotation == made.annotation)).first():
        raise StoreError("This cap was marked again before.")
    connection.execute(insert(repeat).values(**structs.asdict(made), made_at=now()))


def all_repeats(connection: Connection) -> list[tuple[Repeat, int, int]]:
    """All second marks, each with the width and height of its image, the first one first."""
    rows = connection.execute(
        select(repeat, image.c.width, image.c.height)
        .join(image, image.c.id == repeat.c.image)
        .order_by(repeat.c.sequence)
    )
    fields = Repeat.__struct_fields__
    return [(Repeat(**{name: getattr(row, name) for name in fields}), row.width, row.height) for row in rows]


def _is_recent(made_at: str) -> bool:
    return datetime.now(UTC) - datetime.fromisoformat(made_at) < ANOTHER_DAY
