"""A line on stderr that stays the last one, whatever is logged or warned of after it."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def last_line() -> Iterator[Callable[[str], None]]:
    """Yields a function that writes the line; where stderr is no terminal, it is an ordinary line."""
    from rich.console import Console
    from rich.live import Live
    from rich.text import Text

    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda line: console.print(line, markup=False, highlight=False, soft_wrap=True)
        return
    with Live(console=console, auto_refresh=False) as live, _logs_to_stderr_as_it_is():
        yield lambda line: live.update(Text(line), refresh=True)


@contextmanager
def _logs_to_stderr_as_it_is() -> Iterator[None]:
    """Sends logs to ``sys.stderr`` as it is now, so that they too stay above the last line."""
    handlers = [handler for handler in logging.root.handlers if type(handler) is logging.StreamHandler]
    before = [handler.setStream(sys.stderr) for handler in handlers]
    try:
        yield
    finally:
        for handler, stream in zip(handlers, before, strict=True):
            if stream is not None:
                handler.setStream(stream)
