"""The queues of reviewers: which images somebody goes through, and how far they are."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import Connection, func, insert, select, update

from fairyring.storage.db.clock import now
from fairyring.storage.db.schema import image, queue, verdict
from fairyring.storage.records import Queue, SamplingPlan, Says

DECIDED: tuple[Says, ...] = ("approved", "rejected", "sent_back")


def make_queue(
    connection: Connection, title: str, images: Sequence[int], *, plan: SamplingPlan | None = None, user: str
) -> Queue:
    """Gives somebody a queue, in place of the one they had; within ``Project.write``."""
    end_queue(connection, user=user)
    last = connection.execute(select(func.max(verdict.c.sequence))).scalar_one() or 0
    values = {"user": user, "title": title, "images": list(images), "plan": plan, "after_verdict": last}
    number = connection.execute(
        insert(queue).values(**values, made_at=now()).returning(queue.c.sequence)
    ).scalar_one()
    return Queue(number=number, **values)


def queue_of(connection: Connection, user: str) -> Queue | None:
    """The queue that somebody is at, without images that are gone; None where they are at none."""
    row = connection.execute(
        select(queue)
        .where(queue.c.user == user, queue.c.ended_at.is_(None))
        .order_by(queue.c.sequence.desc())
        .limit(1)
    ).first()
    if row is None:
        return None
    there = set(connection.execute(select(image.c.id)).scalars())
    return Queue(
        number=row.sequence,
        user=row.user,
        title=row.title,
        images=[each for each in row.images if each in there],
        plan=row.plan,
        after_verdict=row.after_verdict,
    )


def end_queue(connection: Connection, *, user: str) -> None:
    """Ends the queue that somebody is at; within ``Project.write``."""
    connection.execute(
        update(queue).where(queue.c.user == user, queue.c.ended_at.is_(None)).values(ended_at=now())
    )


def decisions_in(connection: Connection, at: Queue) -> dict[int, Says]:
    """What was last said of each image of a queue since it was made, by whomever; withdrawn ones left out."""
    rows = connection.execute(
        select(verdict.c.image, verdict.c.says)
        .where(
            verdict.c.sequence > at.after_verdict,
            verdict.c.annotation.is_(None),
            verdict.c.says != "comment",
        )
        .order_by(verdict.c.sequence)
    )
    wanted = set(at.images)
    last = {row.image: row.says for row in rows if row.image in wanted}
    return {number: says for number, says in last.items() if says in DECIDED}
