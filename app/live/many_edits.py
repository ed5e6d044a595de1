"""Change sets of many edits: who works them out, without holding up those who drag a cap, and at once.

Somebody who opens an image with many open predictions is likely to accept most of them in one step. The
process that will have to fit them gets to know the image while it is looked at.
"""

from __future__ import annotations

import asyncio
from contextlib import suppress

from fairyring.app.caps.image_caps import ImageCaps
from fairyring.app.caps.tasks import fit_all, take_note
from fairyring.app.live.session import Session
from fairyring.app.workers.crew import Crew
from fairyring.app.workers.worker import LAST, Worker, WorkerError

A_FEW = 20
"""Change sets of more edits than this are many."""
STAYS_S = 1.0
"""Who looks at an image for so long stays on it."""


def worker_of_edits(crew: Crew, image_id: int, *, count: int) -> Worker:
    """Who works out what follows from so many edits of an image."""
    return crew.of_image(image_id) if count <= A_FEW else crew.bulk


def get_ready(crew: Crew, session: Session) -> None:
    """Tells those who will be asked about the image on screen of it, in place of the one before it.

    Who leafs through images does not wait for that: it begins once somebody stays on one.
    """
    if session.getting_ready is not None:
        session.getting_ready.cancel()
    if (caps := session.caps) is not None:
        session.getting_ready = asyncio.create_task(_get_ready(crew, session, caps))


async def _get_ready(crew: Crew, session: Session, caps: ImageCaps) -> None:
    await asyncio.sleep(STAYS_S)
    with suppress(WorkerError):
        # A cap in hand is fitted among its neighbours alone, so nothing but the caps is handed over.
        await session.copy.ask(crew.of_image(caps.image.id), caps, take_note, urgency=LAST)
        if len(caps.predictions) > A_FEW:
            await session.copy.ask(crew.bulk, caps, fit_all, urgency=LAST)
