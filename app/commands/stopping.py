"""A command that is told to end stops as after Ctrl+C, so that it keeps what it has and says how to go on."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from fairyring.model.progress import Progress

INTERRUPTED = 130
"""Exit code after Ctrl+C or SIGTERM; shells report the same after Ctrl+C."""
AGAIN_AFTER_S = 0.05
"""Long enough for Python to be out of what swallowed an interrupt."""


@contextmanager
def swallowed_interrupts_again() -> Iterator[None]:
    """Sends SIGTERM where Python dropped a KeyboardInterrupt: in a finalizer, in a callback of an import."""
    before = sys.unraisablehook

    def hook(unraisable: sys.UnraisableHookArgs) -> None:
        if not issubclass(unraisable.exc_type, KeyboardInterrupt):
            before(unraisable)
            return
        # To the thread, so that it wakes; not SIGINT, which jobs in the background ignore.
        main = threading.main_thread().ident
        again = threading.Timer(AGAIN_AFTER_S, signal.pthread_kill, (main, signal.SIGTERM))
        again.daemon = True
        again.start()

    sys.unraisablehook = hook
    try:
        yield
    finally:
        sys.unraisablehook = before


@contextmanager
def stopped_by_sigterm(progress: Progress) -> Iterator[Progress]:
    """Makes SIGTERM (kill, systemd, containers) act like Ctrl+C: ``progress`` then raises KeyboardInterrupt.

    So work ends between two steps and never within one.
    """
    if threading.current_thread() is not threading.main_thread():
        yield progress
        return
    told = threading.Event()

    def tell(*_: object) -> None:
        told.set()
        # Where all processes were told, those that cut crops have ended, which torch would take for a crash.
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)

    def report(done: int, total: int, what: str) -> None:
        progress(done, total, what)
        if told.is_set():
            raise KeyboardInterrupt

    before = {number: signal.getsignal(number) for number in (signal.SIGTERM, signal.SIGCHLD)}
    signal.signal(signal.SIGTERM, tell)
    try:
        yield report
    except (RuntimeError, OSError, EOFError):
        if told.is_set():
            raise KeyboardInterrupt from None
        raise
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
