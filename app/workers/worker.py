"""A process beside the server, and the thread that hands it one request after another.

What it is asked for are functions of what they are given, so a request may be worked on again where the
process died of it. Where no process can be started, the thread works on requests itself.
"""

from __future__ import annotations

import itertools
import logging
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError, Future
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from multiprocessing.context import ForkServerProcess
from queue import PriorityQueue
from traceback import format_exc
from typing import Any, TypeVar

import cv2

from fairyring.model.errors import FairyringError

log = logging.getLogger(__name__)

PATIENCE_S = 60.0
"""A process that does not answer for so long is ended; what people wait for takes far less than a second."""
BEGINS_WITHIN_S = 60.0
ATTEMPTS = 2
URGENT, ASKED, LAST = range(3)
"""What is more urgent comes first; what is alike, in the order in which it was asked for."""

Found = TypeVar("Found")
Task = tuple[Callable[..., Any], tuple[Any, ...]]
"""A function, which a process can import by its name, and what it is given."""


def keep_at_hand(modules: Sequence[str]) -> None:
    """Has processes that are started from now on share these modules, imported once, by name."""
    multiprocessing.get_context("forkserver").set_forkserver_preload(list(modules))


class WorkerError(FairyringError):
    """A request that no process could finish."""


@dataclass(order=True)
class _Request:
    """What is waited for; its task is made up just before it is handed over."""

    urgency: int
    number: int
    task: Callable[[], Task] = field(compare=False)
    answer: Future[Any] = field(compare=False, default_factory=Future)


class Worker:
    """One process, started with the first request. Any thread may ask.

    An answer that nobody waits for any longer, whose future was cancelled, is not worked out.
    """

    def __init__(
        self, name: str, *, nice: int = 0, apart: bool = True, patience_s: float = PATIENCE_S
    ) -> None:
        """``nice`` as for the shell's command; without ``apart`` the thread does everything."""
        self._nice = nice
        self._apart = apart
        self._patience_s = patience_s
        self._requests: PriorityQueue[_Request] = PriorityQueue()
        self._numbers = itertools.count()
        self._process: _Process | None = None
        self.started = 0
        """How many processes there have been; none knows what the one before was told."""
        self._closed = threading.Event()
        self._thread = threading.Thread(target=self._answer_all, name=name, daemon=True)
        self._thread.start()

    def ask(self, task: Callable[[], Task], *, urgency: int = ASKED) -> Future[Any]:
        """The answer to come. ``task`` is called, by the thread, when its turn has come.

        The future raises what the function raises, or WorkerError.
        """
        request = _Request(urgency, next(self._numbers), task)
        self._requests.put(request)
        if self._closed.is_set():
            request.answer.cancel()
        return request.answer

    def run(self, work: Callable[..., Found], /, *given: Any) -> Found:
        """Asks, after whatever else is asked for, and waits. Raises what ``work`` raises, and WorkerError."""
        try:
            return self.ask(lambda: (work, given), urgency=LAST).result()
        except CancelledError:
            raise WorkerError("This was not worked out: the server is ending.") from None

    def close(self) -> None:
        """Ends the process, whatever it is at, and answers nothing more."""
        self._closed.set()
        self._requests.put(_Request(URGENT, -1, _nothing))
        process = self._process
        if process is not None:
            process.kill()
        self._thread.join(timeout=5)

    def _answer_all(self) -> None:
        # Ctrl+C is for the server to answer, and not for a process that this thread is starting.
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        while not self._closed.is_set():
            request = self._requests.get()
            if self._closed.is_set() or not request.answer.set_running_or_notify_cancel():
                request.answer.cancel()
                continue
            try:
                found = self._answer(request)
            except BaseException as error:
                request.answer.set_exception(error)
            else:
                request.answer.set_result(found)
        if self._process is not None:
            self._process.end()
        while not self._requests.empty():
            self._requests.get().answer.cancel()

    def _answer(self, request: _Request) -> Any:
        for _ in range(ATTEMPTS):
            try:
                if self._apart and self._process is None:
                    self.started += 1
                    self._process = _Process(nice=self._nice)
                work, given = request.task()
                if self._process is None:
                    return work(*given)
                return self._process.answer(work, given, within_s=self._patience_s)
            except _DiedError as died:
                if self._process is not None:
                    self._process.end()
                self._process, self._apart = None, self._apart and died.had_begun
                if self._closed.is_set():
                    break
                log.warning("%s: %s", self._thread.name, died)
        raise WorkerError("This could not be worked out: the process that was at it died.")


class _DiedError(Exception):
    """A process that ended, or had to be ended, before it answered."""

    def __init__(self, why: object, *, had_begun: bool) -> None:
        instead = "another is started" if had_begun else "the server computes by itself"
        super().__init__(f"A process that computes for the server has died ({why}); {instead}.")
        self.had_begun = had_begun


class _Process:
    """The process, on its way up or ready."""

    def __init__(self, *, nice: int) -> None:
        context = multiprocessing.get_context("forkserver")
        self._line, theirs = context.Pipe()
        self._has_begun = False
        self._process: ForkServerProcess = context.Process(target=_serve, args=(theirs, nice), daemon=True)
        try:
            self._process.start()
        except (OSError, EOFError, RuntimeError) as error:
            raise _DiedError(error, had_begun=False) from error
        finally:
            theirs.close()

    def answer(self, work: Callable[..., Any], given: tuple[Any, ...], *, within_s: float) -> Any:
        """What the function returns or raises there. Raises _DiedError where the process dies, or must."""
        try:
            if not self._has_begun:
                self._receive(within_s=BEGINS_WITHIN_S)
                self._has_begun = True
            self._line.send((work, given))
            is_right, found = self._receive(within_s=within_s)
        except (EOFError, OSError) as error:
            raise _DiedError(repr(error), had_begun=self._has_begun) from error
        if is_right:
            return found
        raise found

    def _receive(self, *, within_s: float) -> Any:
        if not self._line.poll(within_s):
            raise TimeoutError(f"no answer for {within_s:.0f} s")
        return self._line.recv()

    def kill(self) -> None:
        """Has it end; the thread that waits for its answer hears of it."""
        if self._process.pid is not None:
            self._process.kill()

    def end(self) -> None:
        """Ends it at once and lets go of it."""
        self.kill()
        if self._process.pid is not None:
            self._process.join(timeout=5)
        self._line.close()


def _serve(line: Connection, nice: int) -> None:
    """Answers, in a process of its own, until the other end is gone, be it by SIGKILL."""
    # Ctrl+C in a terminal reaches all processes of the server, which alone answers it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    cv2.setNumThreads(1)
    os.nice(nice)
    try:
        line.send("ready")
        while True:
            work, given = line.recv()
            line.send(_outcome(work, given))
    except (EOFError, OSError):
        return


def _outcome(work: Callable[..., Any], given: tuple[Any, ...]) -> tuple[bool, Any]:
    """Whether the function returned, and what it returned or raised."""
    try:
        return True, work(*given)
    except Exception as error:
        # What was raised where cannot be sent along.
        error.add_note(format_exc())
        return False, error


def _nothing() -> Task:
    raise AssertionError("nobody asks for this")
