"""Progress of a command: a bar on stderr, so that stdout holds figures alone."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from fairyring.model.progress import Progress


@contextmanager
def shown_on_stderr(*, silent: bool = False) -> Iterator[Progress]:
    """Shows a bar with the time left while the block runs; nothing if ``silent`` or stderr is no terminal."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    console = Console(stderr=True)
    with Bar(*columns, console=console, transient=True, disable=silent or not console.is_terminal) as bar:
        task = bar.add_task("", total=None)

        def report(done: int, total: int, what: str) -> None:
            bar.update(task, completed=done, total=total, description=what)

        yield report
