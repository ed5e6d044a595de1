"""Passes edits on from a tab to the disk and to the other tabs, and answers refits while a cap is dragged."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Sequence

import anyio.to_thread

from fairyring.app.caps.image_caps import ImageCaps
from fairyring.app.caps.whole_outlines import derive_edits, refit
from fairyring.app.live.repairs import repairs_told
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.protocol import Changed, Outcomes, Refit
from fairyring.storage.journal import commit
from fairyring.storage.records import Accepted, Conflict, Edit, Outcome

log = logging.getLogger(__name__)


async def apply_edits(workspace: Workspace, session: Session, edits: Sequence[Edit]) -> None:
    """Stores a change set; the acknowledgement goes out once the transaction is on disk."""
    session.storing = {edit.annotation for edit in edits}
    try:
        outcomes = await anyio.to_thread.run_sync(_store, workspace, edits, session.caps, session.user)
        session.send(Outcomes(outcomes=outcomes))
        accepted = [outcome.annotation for outcome in outcomes if isinstance(outcome, Accepted)]
        session.take_in(accepted)
        session.take_in([outcome.theirs for outcome in outcomes if isinstance(outcome, Conflict)])
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


def _store(workspace: Workspace, edits: Sequence[Edit], known: ImageCaps | None, user: str) -> list[Outcome]:
    return commit(workspace.project, derive_edits(workspace.project, edits, known=known), user=user)


class Refits:
    """Answers the refits of one tab: one at a time, and of those that wait only the latest."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._latest: Refit | None = None
        self._task: asyncio.Task[None] | None = None

    def ask(self, request: Refit) -> None:
        """Asks for a refit, in place of one that has not been begun."""
        self._latest = request
        if self._task is None:
            self._task = asyncio.create_task(self._answer())

    def close(self) -> None:
        """Drops the request that waits."""
        self._latest = None

    async def _answer(self) -> None:
        try:
            while (request := self._latest) is not None:
                self._latest = None
                caps = self._session.caps
                if caps is not None and caps.image.id == request.image:
                    self._session.send(await anyio.to_thread.run_sync(refit, caps, request))
        except Exception:
            log.exception("A refit failed.")
        finally:
            self._task = None
