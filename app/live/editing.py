"""Passes edits on from a tab to the disk and to the other tabs, and answers refits while a cap is dragged."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Sequence
from functools import partial

import anyio.to_thread

from fairyring.app.caps.copies import Copy
from fairyring.app.caps.whole_outlines import derived_of, load_caps, refit
from fairyring.app.live.repairs import repairs_told
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.protocol import Changed, Outcomes, Refit
from fairyring.app.workers.worker import URGENT, WorkerError
from fairyring.storage.journal import Derived, commit
from fairyring.storage.records import Accepted, Conflict, Edit, Refused

log = logging.getLogger(__name__)

MOST_EDITS = 10_000
"""Most edits of a change set: so many hold the writer for half a second."""
A_FEW = 20
"""Change sets of more edits than this do not hold up those who drag a cap."""


async def apply_edits(workspace: Workspace, session: Session, edits: Sequence[Edit]) -> None:
    """Stores a change set; the acknowledgement goes out once the transaction is on disk."""
    if len(edits) > MOST_EDITS:
        reason = f"A change set holds at most {MOST_EDITS} edits; make this in several steps."
        session.send(Outcomes(outcomes=[Refused(edit=edit.id, reason=reason) for edit in edits]))
        return
    session.storing = {edit.annotation for edit in edits}
    try:
        derived = await _derive(workspace, session, edits)
        outcomes = await anyio.to_thread.run_sync(
            partial(commit, workspace.project, derived, user=session.user)
        )
        session.send(Outcomes(outcomes=outcomes))
        accepted = [outcome.annotation for outcome in outcomes if isinstance(outcome, Accepted)]
        session.take_in(accepted)
        session.take_in([outcome.theirs for outcome in outcomes if isinstance(outcome, Conflict)])
        for said in {each.fit.refusal for each in derived if each.edit.cap and each.edit.cap.mark}:
            if said is not None:
                session.notify(said, "warning")
        if told := await anyio.to_thread.run_sync(repairs_told, edits, outcomes):
            session.notify(told)
    finally:
        session.storing = set()
    for image_id in {annotation.image for annotation in accepted}:
        workspace.reviewer.touch(image_id)
        changed = [annotation for annotation in accepted if annotation.image == image_id]
        for tab in workspace.tabs.others_on(image_id, besides=session):
            tab.take_in(changed)
            tab.send(Changed(image=image_id, annotations=changed, user=session.user))
            tab.refresh("cap")
    session.refresh("cap", "status")


async def _derive(workspace: Workspace, session: Session, edits: Sequence[Edit]) -> list[Derived]:
    """What is worked out from the caps of a change set, by the workers, as if all of it were stored."""
    found: dict[str, Derived] = {}
    for image_id in {edit.image for edit in edits}:
        of_image = [edit for edit in edits if edit.image == image_id]
        caps, copy = session.caps, session.copy
        if caps is None or caps.image.id != image_id:
            caps, copy = await anyio.to_thread.run_sync(load_caps, workspace.project, image_id), Copy()
        if caps is not None:
            worker = workspace.crew.of_image(image_id) if len(of_image) <= A_FEW else workspace.crew.patient
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
