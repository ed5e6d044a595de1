"""Long work off the event loop: in a thread, with progress, cancel, a result or an error as a sentence."""

from __future__ import annotations

import asyncio
import itertools
import logging
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Literal

import anyio
import anyio.to_thread

from fairyring.model.errors import FairyringError
from fairyring.model.progress import Progress

log = logging.getLogger(__name__)

State = Literal["running", "done", "failed", "cancelled"]

ITSELF = "Fairyring"
"""Who started a job that nobody asked for."""
KEPT = 12
"""How many finished jobs stay listed."""
UNEXPECTED = "This stopped because of an error in Fairyring itself; the server's log says more."


class CancelledError(Exception):
    """Raised inside a job's work by its progress callback, so that the work unwinds."""


@dataclass(eq=False, kw_only=True)
class Job:
    """One piece of long work, as the panel shows it."""

    id: int
    title: str
    user: str
    state: State = "running"
    done: int = 0
    total: int = 0
    what: str = ""
    message: str = ""
    """The result, or why there is none, in a sentence."""
    link: str = ""
    """Address at which the browser can fetch what the job made."""
    stop: threading.Event = field(default_factory=threading.Event)
    _counted: tuple[float, int] | None = None
    """When the first step was counted, and how many had been done then."""

    def cancel(self) -> None:
        """Asks the work to stop at its next step."""
        self.stop.set()

    def report(self, done: int, total: int, what: str) -> None:
        """The progress callback handed to the work; called from its thread."""
        if self.stop.is_set():
            raise CancelledError
        self.done, self.total, self.what = done, total, what
        if total and (self._counted is None or done < self._counted[1]):
            self._counted = (time.monotonic(), done)

    def may_be_cancelled_by(self, user: str) -> bool:
        """Whether it is this person's own, or nobody's."""
        return self.user in (user, ITSELF)

    @property
    def seconds_left(self) -> float | None:
        """How long the rest takes at the pace so far; None while nothing is done that tells it."""
        if self._counted is None or self.state != "running":
            return None
        began, before = self._counted
        steps = self.done - before
        return (self.total - self.done) * (time.monotonic() - began) / steps if steps > 0 else None


@dataclass(frozen=True)
class Result:
    """What a job reports at its end."""

    message: str
    link: str = ""


class Jobs:
    """The jobs of a served project, newest first. Used on the gateway's event loop only."""

    def __init__(self, *, at_once: int = 1) -> None:
        self._jobs: list[Job] = []
        self._tasks: set[asyncio.Task[None]] = set()
        self._ids = itertools.count(1)
        self._slots = anyio.CapacityLimiter(at_once)

    def __iter__(self) -> Iterator[Job]:
        return iter(tuple(self._jobs))

    @property
    def running(self) -> list[Job]:
        """The jobs that are still at work, or wait for their turn."""
        return [job for job in self._jobs if job.state == "running"]

    def start(
        self, title: str, work: Callable[[Progress], Result], *, user: str, finished: Callable[[Job], None]
    ) -> Job:
        """Runs ``work`` in a thread; ``finished`` is called on the event loop when it has ended."""
        job = Job(id=next(self._ids), title=title, user=user)
        ended = [old for old in self._jobs if old.state != "running"]
        self._jobs = [job, *(old for old in self._jobs if old not in ended[KEPT - 1 :])]
        task = asyncio.create_task(self._carry_out(job, work, finished))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return job

    def find(self, job_id: int) -> Job | None:
        """The job of this number, while it is listed."""
        return next((job for job in self._jobs if job.id == job_id), None)

    async def close(self) -> None:
        """Cancels what is running and waits for it to unwind."""
        for job in self._jobs:
            job.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    async def _carry_out(
        self, job: Job, work: Callable[[Progress], Result], finished: Callable[[Job], None]
    ) -> None:
        try:
            result = await anyio.to_thread.run_sync(work, job.report, limiter=self._slots)
            job.state, job.message, job.link = "done", result.message, result.link
        except CancelledError:
            job.state, job.message = "cancelled", "Cancelled; what was done so far is kept."
        except FairyringError as error:
            job.state, job.message = "failed", str(error)
        except Exception:
            log.exception("The job %r failed.", job.title)
            job.state, job.message = "failed", UNEXPECTED
        finished(job)
