"""Answers what the network sees where somebody points."""

from __future__ import annotations

import asyncio
import logging

from fairyring.app.caps.found_caps import Asked, cap_found, near
from fairyring.app.caps.image_caps import ImageCaps
from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.protocol import FindCap, FoundCap
from fairyring.app.weights import require_weights
from fairyring.app.workers.worker import URGENT
from fairyring.model.errors import FairyringError

log = logging.getLogger(__name__)

Found = tuple[float, list[list[float]]] | None
"""Score and outline; None where the network sees no cap."""


class Finding:
    """Answers one tab: one question at a time, and of those that wait only the latest."""

    def __init__(self, workspace: Workspace, session: Session) -> None:
        self._workspace = workspace
        self._session = session
        self._latest: FindCap | None = None
        self._asked: tuple[FindCap, asyncio.Future[Found]] | None = None
        self._task: asyncio.Task[None] | None = None

    def ask(self, request: FindCap) -> None:
        """Asks, in place of a question that has not been begun, or is about another image."""
        self._latest = request
        if self._asked is not None and self._asked[0].image != request.image:
            self._asked[1].cancel()
        if self._task is None:
            self._task = asyncio.create_task(self._answer_all())

    def close(self) -> None:
        """Drops what waits, and what is at work unless it has been begun."""
        self._latest = None
        if self._asked is not None:
            self._asked[1].cancel()
        if self._task is not None:
            self._task.cancel()

    async def _answer_all(self) -> None:
        try:
            while (request := self._latest) is not None:
                self._latest = None
                await self._answer(request)
        finally:
            self._task = None

    async def _answer(self, request: FindCap) -> None:
        found: Found = None
        try:
            found = await self._found(request)
        except FairyringError as error:
            # Nobody asked for a first look, and whoever asks for a cap later is told.
            if request.points or request.box:
                self._session.notify(str(error), "error")
        except Exception:
            log.exception("The network could not be asked.")
        score, visible = found or (None, None)
        self._session.send(FoundCap(seq=request.seq, image=request.image, visible=visible, score=score))

    async def _found(self, request: FindCap) -> Found:
        caps = self._session.caps
        if caps is None or caps.image.id != request.image:
            return None
        # In the worker's own thread: who rests with the pointer waits for every change of threads.
        network = self._workspace.crew.network
        answer = network.ask(lambda: (cap_found, (self._asked_of(request, caps),)), urgency=URGENT)
        waited_for = asyncio.wrap_future(answer)
        self._asked = request, waited_for
        try:
            await asyncio.wait({waited_for})
        finally:
            self._asked = None
        return None if waited_for.cancelled() else waited_for.result()

    def _asked_of(self, request: FindCap, caps: ImageCaps) -> Asked:
        """What the worker needs to know. For a thread."""
        project = self._workspace.project
        box = request.box
        places = request.points or ([((box[0] + box[2]) / 2, (box[1] + box[3]) / 2)] if box else [])
        return Asked(
            photo=project.originals.path_of(caps.image),
            weights=require_weights(project),
            points=request.points,
            wanted=request.wanted,
            box=box,
            front=near(caps, places, besides=request.besides),
        )
