"""Callbacks from viser's event loop to the gateway's, and the redrawing of the panel's parts."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable, Coroutine
from typing import Any

import viser

from fairyring.app.live.session import Session
from fairyring.model.errors import FairyringError

log = logging.getLogger(__name__)

UNEXPECTED = "That did not work because of an error in Fairyring; the server's log says more."
REDRAW_AFTER_S = 0.1
"""Delay of a redraw: quick successions are drawn once, and after the editor has drawn."""
FOLLOW_AFTER_S = 1.0
"""Delay of a redraw that nobody waits for: with twenty people at work something changes all the time."""
Redraw = Callable[[], Awaitable[None]]
"""Draws one part of a panel anew."""
Callback = Callable[[viser.GuiEvent[Any]], Coroutine[Any, Any, None]]


def person_did(session: Session, work: Callable[[], Awaitable[None]]) -> Callback:
    """A viser callback that runs ``work`` on the gateway's loop, in the order in which things were done.

    Values set by the server itself do not count. What goes wrong is said to the person at the tab.
    """
    loop = asyncio.get_running_loop()

    async def callback(event: viser.GuiEvent[Any]) -> None:
        if event.client is not None:
            asyncio.run_coroutine_threadsafe(tell_errors(session, work), loop)

    return callback


async def tell_errors(session: Session, work: Callable[[], Awaitable[None]]) -> None:
    """Does ``work``; shows the person at the tab what goes wrong."""
    try:
        await work()
    except FairyringError as error:
        session.notify(str(error), "error")
    except Exception:
        log.exception("Something that %s asked for failed.", session.user)
        session.notify(UNEXPECTED, "error")


class Redrawing:
    """Redraws the out-of-date parts of one tab's panel, after a short delay and one at a time."""

    def __init__(self, parts: dict[str, Redraw]) -> None:
        self._parts = parts
        self._wanted: set[str] = set()
        self._task: asyncio.Task[None] | None = None
        self._later: set[str] = set()

    def ask(self, parts: tuple[str, ...], *, after_s: float = REDRAW_AFTER_S) -> None:
        """Marks parts as out of date."""
        self._wanted.update(part for part in parts if part in self._parts)
        if self._task is None and self._wanted:
            self._task = asyncio.create_task(self._draw(after_s))

    def ask_at_once(self, parts: tuple[str, ...]) -> None:
        """The same where somebody waits for nothing but this."""
        self.ask(parts, after_s=0.0)

    def ask_later(self, parts: tuple[str, ...]) -> None:
        """Marks parts as out of date, and draws them together with what else becomes so until then."""
        if not self._later:
            asyncio.get_running_loop().call_later(FOLLOW_AFTER_S, self._ask_collected)
        self._later.update(parts)

    def _ask_collected(self) -> None:
        parts, self._later = tuple(self._later), set()
        self.ask(parts)

    async def _draw(self, after_s: float) -> None:
        try:
            await asyncio.sleep(after_s)
            while self._wanted:
                part = next(name for name in self._parts if name in self._wanted)
                self._wanted.discard(part)
                try:
                    await self._parts[part]()
                except Exception:
                    log.exception("The panel part %r could not be drawn.", part)
        finally:
            self._task = None
