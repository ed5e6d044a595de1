"""A line on stderr that stays the last one, whatever is logged or warned of after it."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def last_line() -> Iterator[Callable[[str], None]]:
    """Yields what writes the line. Where stderr is no terminal, it is written once, like any other."""
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
    """While ``sys.stderr`` stands for a terminal whose last line is kept, logs take that way too."""
    handlers = [handler for handler in logging.root.handlers if type(handler) is logging.StreamHandler]
    before = [handler.setStream(sys.stderr) for handler in handlers]
    try:
        yield
    finally:
        for handler, stream in zip(handlers, before, strict=True):
            if stream is not None:
                handler.setStream(stream)
