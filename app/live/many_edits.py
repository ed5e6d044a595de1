"""Change sets of many edits: who works them out, without holding up those who drag a cap, and at once.

Somebody who opens an image with many open predictions is likely to accept most of them in one step. The
process that will have to fit them gets to know the image while it is looked at, and so does the one
for single caps.
"""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from contextlib import suppress

from fairyring.app.caps.image_caps import ImageCaps
from fairyring.app.live.session import Session
from fairyring.app.workers.crew import Crew
from fairyring.app.workers.worker import LAST, Worker, WorkerError

A_FEW = 20
"""Change sets of more edits than this are many."""


def worker_of_edits(crew: Crew, image_id: int, *, count: int) -> Worker:
    """Who works out what follows from so many edits of an image."""
    return crew.of_image(image_id) if count <= A_FEW else crew.bulk


def get_ready(crew: Crew, session: Session) -> None:
    """Has the image on screen fitted by those who will be asked about it, in place of the one before it."""
    if session.getting_ready is not None:
        session.getting_ready.cancel()
    if (caps := session.caps) is not None:
        workers = [crew.of_image(caps.image.id), *([crew.bulk] if len(caps.predictions) > A_FEW else [])]
        session.getting_ready = asyncio.create_task(_get_ready(workers, session, caps))


async def _get_ready(workers: Sequence[Worker], session: Session, caps: ImageCaps) -> None:
    for worker in workers:
        with suppress(WorkerError):
            await session.copy.ask(worker, caps, fit_all, urgency=LAST)


def fit_all(caps: ImageCaps) -> None:
    """Fits all that is visible: what is asked later is known already."""
    visible = list(caps.visible.values())
    caps.fitting.reconstructions(visible, visible=visible)
