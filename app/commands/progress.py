"""Progress of a command on stderr, so that stdout holds figures alone: a bar, or lines without a terminal.

A command that shows its progress is stopped between two steps, never within one.
"""

from __future__ import annotations

import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

import typer

from fairyring.model.progress import Progress

EVERY_S = 5.0
"""Seconds between two lines where stderr is no terminal."""


@contextmanager
def shown_on_stderr(*, silent: bool = False) -> Iterator[Progress]:
    """Shows a bar with the time left while the block runs, without a terminal lines; ``silent``: nothing."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    console = Console(stderr=True)
    if silent or not console.is_terminal:
        yield _ignored if silent else _lines()
        return
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    with Bar(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=None)

        def report(done: int, total: int, what: str) -> None:
            bar.update(task, completed=done, total=total, description=what)

        yield report


@contextmanager
def steps_shown() -> Iterator[Progress]:
    """As ``shown_on_stderr``; Ctrl+C and SIGTERM end the work at its next step, a second one at once.

    So nothing is stopped between what belongs together: a transaction and the photos it is about.
    """
    with shown_on_stderr() as shown:
        if threading.current_thread() is not threading.main_thread():
            yield shown
            return
        told = threading.Event()

        def tell(_number: int, _frame: FrameType | None) -> None:
            if told.is_set():
                raise KeyboardInterrupt
            told.set()
            typer.echo("Stopping after this step; once more stops at once.", err=True)

        def report(done: int, total: int, what: str) -> None:
            if told.is_set():
                raise KeyboardInterrupt
            shown(done, total, what)

        before = {number: signal.signal(number, tell) for number in (signal.SIGINT, signal.SIGTERM)}
        try:
            yield report
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)


@contextmanager
def time_told(what: str) -> Iterator[None]:
    """Says every few seconds for how long the block has been at it, where it cannot say how far it is."""
    began, ended = time.monotonic(), threading.Event()

    def tell() -> None:
        while not ended.wait(EVERY_S):
            typer.echo(f"{what}: {time.monotonic() - began:.0f} s", err=True)

    telling = threading.Thread(target=tell, daemon=True)
    telling.start()
    try:
        yield
    finally:
        ended.set()
        telling.join()


def _ignored(_done: int, _total: int, _what: str) -> None:
    pass


def _lines() -> Progress:
    """A progress that writes a line every few seconds, the first after as many."""
    last = time.monotonic()

    def report(done: int, total: int, what: str) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= EVERY_S:
            last = now
            typer.echo(f"{what}: {done} of {total}" if total else f"{what} …", err=True)
            sys.stderr.flush()

    return report
