"""Passes edits on from a tab to the disk and to the other tabs, and answers refits while a cap is dragged."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Sequence
from functools import partial

import anyio.to_thread
from sqlalchemy import Connection

from fairyring.app.caps.copies import Copy
from fairyring.app.caps.whole_outlines import derived_of, load_caps, refit
from fairyring.app.live.confirming import confirm
from fairyring.app.live.many_edits import A_FEW, worker_of_edits
from fairyring.app.live.repairs import repairs_told
from fairyring.app.live.session import Session
from fairyring.app.live.statuses import announce_statuses
from fairyring.app.live.workspace import Workspace
from fairyring.app.protocol import Changed, Edits, Outcomes, Refit, Working
from fairyring.app.workers.worker import URGENT, WorkerError
from fairyring.storage.images import get_image
from fairyring.storage.journal import Derived, commit, known_outcomes
from fairyring.storage.records import Accepted, Conflict, Edit, Image, Outcome, Refused, StatusStored

log = logging.getLogger(__name__)

MOST_EDITS = 10_000
"""Most edits of a change set: so many hold the writer for half a second."""
SAY_WORKING_S = 3.0
"""A tab gives up on a connection that says nothing for several times as long."""


async def apply_edits(workspace: Workspace, session: Session, message: Edits) -> None:
    """Stores a change set or a piece of one; the acknowledgement goes out once the transaction is on disk."""
    sent = [*message.edits, *message.statuses, *message.verdicts]
    if len(sent) > MOST_EDITS:
        reason = f"A change set holds at most {MOST_EDITS} edits; make this in several steps."
        refused = [Refused(edit=edit.id, reason=reason) for edit in sent]
        session.send(Outcomes(outcomes=[*refused]))
        return
    session.storing = {edit.annotation for edit in message.edits}
    working = asyncio.create_task(_say_working(session))
    try:
        outcomes, derived = await _store(workspace, session, message)
        accepted = [outcome.annotation for outcome in outcomes if isinstance(outcome, Accepted)]
        # Before the outcomes: a tab that hears of both never shows the status as it was.
        images = await workspace.read(partial(_images_of, outcomes=outcomes))
        announce_statuses(workspace, images, user=session.user)
        session.send(Outcomes(outcomes=outcomes))
        session.take_in(accepted)
        session.take_in([outcome.theirs for outcome in outcomes if isinstance(outcome, Conflict)])
        for said in {each.fit.refusal for each in derived if each.edit.cap and each.edit.cap.mark}:
            if said is not None:
                session.notify(said, "warning")
        if told := await anyio.to_thread.run_sync(repairs_told, message.edits, outcomes):
            session.notify(told)
    finally:
        working.cancel()
        session.storing = set()
    for image_id in {annotation.image for annotation in accepted}:
        workspace.reviewer.touch(image_id)
        changed = [annotation for annotation in accepted if annotation.image == image_id]
        for tab in workspace.tabs.others_on(image_id, besides=session):
            tab.take_in(changed)
            tab.send(Changed(image=image_id, annotations=changed, user=session.user))
            tab.follow("cap", "history")
    session.refresh("cap", "status")
    session.follow("history")
    if message.statuses or message.verdicts:
        workspace.follow("desk", "queue", "cap", "history", "status", "images")
        await confirm(workspace, session, message, outcomes)


async def _say_working(session: Session) -> None:
    """Tells the tab again and again that it has been heard, so that it waits."""
    while True:
        await asyncio.sleep(SAY_WORKING_S)
        session.send(Working())


async def _store(
    workspace: Workspace, session: Session, message: Edits
) -> tuple[list[Outcome], list[Derived]]:
    """Stores what is not stored already, once what follows from it is worked out; also returns that.

    Of many edits, those stored already are answered first: sent again, they would all be worked out again.
    """
    answered: dict[str, Accepted] = {}
    if len(message.edits) > A_FEW:
        answered = await workspace.read(partial(known_outcomes, edits=message.edits))
    new = [edit for edit in message.edits if edit.id not in answered]
    derived = await _derive(workspace, session, new)
    said = {"statuses": message.statuses, "verdicts": message.verdicts}
    store = partial(commit, workspace.project, derived, **said, user=session.user)
    fresh = iter(await anyio.to_thread.run_sync(store))
    return [answered.get(edit.id) or next(fresh) for edit in message.edits] + list(fresh), derived


def _images_of(connection: Connection, *, outcomes: Sequence[Outcome]) -> list[Image]:
    """The images of what was accepted, as they are now."""
    touched = {outcome.annotation.image for outcome in outcomes if isinstance(outcome, Accepted)}
    touched |= {outcome.image for outcome in outcomes if isinstance(outcome, StatusStored)}
    return [get_image(connection, image_id) for image_id in sorted(touched)]


async def _derive(workspace: Workspace, session: Session, edits: Sequence[Edit]) -> list[Derived]:
    """What is worked out from the caps of a change set, by the workers, as if all of it were stored."""
    found: dict[str, Derived] = {}
    for image_id in {edit.image for edit in edits}:
        of_image = [edit for edit in edits if edit.image == image_id]
        caps, copy = session.caps, session.copy
        if caps is None or caps.image.id != image_id:
            caps, copy = await anyio.to_thread.run_sync(load_caps, workspace.project, image_id), Copy()
        if caps is not None:
            worker = worker_of_edits(workspace.crew, image_id, count=len(of_image))
            try:
                derived = await copy.ask(worker, caps, derived_of, of_image, urgency=URGENT)
            except WorkerError as error:
                # Stored, it would be asked about again and again.
                derived = [Derived(edit=edit, unfit=str(error)) for edit in of_image]
            found |= {each.edit.id: each for each in derived}
    return [found.get(edit.id) or Derived(edit=edit) for edit in edits]


class Refits:
    """Answers the refits of one tab: one at a time, and of those that wait only the latest."""

    def __init__(self, workspace: Workspace, session: Session) -> None:
        self._crew = workspace.crew
        self._session = session
        self._latest: Refit | None = None
        self._task: asyncio.Task[None] | None = None

    def ask(self, request: Refit) -> None:
        """Asks for a refit, in place of one that has not been begun."""
        self._latest = request
        if self._task is None:
            self._task = asyncio.create_task(self._answer())

    def close(self) -> None:
        """Drops the request that waits, and the one that is at work unless it has been begun."""
        self._latest = None
        if self._task is not None:
            self._task.cancel()

    async def _answer(self) -> None:
        try:
            while (request := self._latest) is not None:
                self._latest = None
                caps = self._session.caps
                if caps is not None and caps.image.id == request.image:
                    worker = self._crew.of_image(request.image)
                    self._session.send(await self._session.copy.ask(worker, caps, refit, request))
        except WorkerError as error:
            log.warning("%s", error)
        except Exception:
            log.exception("A refit failed.")
        finally:
            self._task = None
