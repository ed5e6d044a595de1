"""The queue that a person goes through: made, ended, and its rest approved once a sample has passed."""

from __future__ import annotations

from functools import partial
from uuid import uuid4

import anyio.to_thread

from fairyring.app.how_many import how_many
from fairyring.app.live.opening import open_image
from fairyring.app.live.session import Session
from fairyring.app.live.statuses import announce_statuses
from fairyring.app.live.workspace import Workspace
from fairyring.app.review.queueing import has_passed, rest_of, standing_of
from fairyring.model.errors import FairyringError
from fairyring.storage.images import get_image
from fairyring.storage.journal import commit
from fairyring.storage.queues import decisions_in, end_queue, make_queue, queue_of
from fairyring.storage.records import Queue, Refused, SamplingPlan, Verdict


async def take_up_queue(workspace: Workspace, session: Session) -> None:
    """Has a tab go on with the queue that its person was at."""
    queue = await workspace.read(partial(queue_of, user=session.user))
    session.queue = tuple(queue.images) if queue else ()


async def begin_queue(
    workspace: Workspace, session: Session, title: str, images: list[int], plan: SamplingPlan | None
) -> None:
    """Gives the person at a tab a queue, in all their tabs, and shows the first image of it.

    Raises FairyringError where there is nothing to go through.
    """
    if not images:
        raise FairyringError("No image fits this queue.")
    make = partial(make_queue, title=title, images=images, plan=plan, user=session.user)
    await workspace.write(make)
    _tell_tabs(workspace, session.user, tuple(images))
    await open_image(workspace, session, images[0])


async def leave_queue(workspace: Workspace, session: Session) -> None:
    """Ends the queue of the person at a tab."""
    await workspace.write(partial(end_queue, user=session.user))
    _tell_tabs(workspace, session.user, ())
    session.refresh("status", "images", "desk", "queue")


async def approve_rest(workspace: Workspace, session: Session) -> None:
    """Approves what a sample that has passed was drawn from. Raises FairyringError where none has."""
    queue = await workspace.read(partial(queue_of, user=session.user))
    if queue is None or queue.plan is None:
        raise FairyringError("There is no sample whose rest could be approved.")
    standing = standing_of(queue, await workspace.read(partial(decisions_in, at=queue)))
    if not has_passed(queue, standing):
        raise FairyringError("The sample has not passed: look at all its images first.")
    words = f"By a sample: {standing.wrong} of {standing.done} wrong, {queue.plan.allowed} allowed"
    approved, refused = await anyio.to_thread.run_sync(partial(_approve, workspace, session, queue, words))
    images = await workspace.read(lambda connection: [get_image(connection, each) for each in approved])
    announce_statuses(workspace, images, user=session.user)
    told = f"{how_many(len(approved), 'image')} approved."
    session.notify(f"{told} {len(refused)} not: {refused[0]}" if refused else told)
    workspace.refresh("images", "desk", "queue", "status")


def _approve(workspace: Workspace, session: Session, queue: Queue, words: str) -> tuple[list[int], list[str]]:
    """Which images were approved, and why others were not."""
    with workspace.project.read() as connection:
        waiting = [each for each in rest_of(queue) if get_image(connection, each).status != "approved"]
    verdicts = [Verdict(id=uuid4().hex, image=each, says="approved", words=words) for each in waiting]
    outcomes = commit(workspace.project, [], verdicts=verdicts, user=session.user)
    refused = [outcome.reason for outcome in outcomes if isinstance(outcome, Refused)]
    approved = [
        each for each, outcome in zip(waiting, outcomes, strict=True) if not isinstance(outcome, Refused)
    ]
    return approved, refused


def _tell_tabs(workspace: Workspace, user: str, images: tuple[int, ...]) -> None:
    for tab in workspace.tabs:
        if tab.user == user:
            tab.queue = images
            tab.refresh("queue")
