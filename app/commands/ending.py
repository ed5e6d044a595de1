"""How commands end that are stopped, or that meet an error nobody foresaw."""

from __future__ import annotations

import platform
import signal
import sys
import tempfile
import threading
import traceback
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import Any

import typer
from typer.core import TyperGroup

from fairyring.app.commands.stopping import INTERRUPTED, swallowed_interrupts_again
from fairyring.app.commands.version import version
from fairyring.model.errors import FairyringError

BEGIN_ANEW = "Nothing was written; the same command begins anew."
OUTLINES_KEPT = "Nothing was written; whole outlines found so far are kept. The same command goes on."
UNCHANGED = "Nothing was changed; the same command begins anew."
AFTER: Mapping[str, str] = MappingProxyType(
    {
        "init": "If no project was made, the same command goes on.",
        "import": UNCHANGED,
        "export": OUTLINES_KEPT,
        "review": OUTLINES_KEPT,
        "runs": OUTLINES_KEPT,
        "take-out": UNCHANGED,
        "put-back": UNCHANGED,
        "split": UNCHANGED,
        "rules": UNCHANGED,
        "relink": UNCHANGED,
        "demo": "What was made is kept; the same command goes on.",
        "synth": "The beds rendered so far are kept; the same command with --resume goes on.",
        "serve": "The project is closed; every edit that was said to be saved is on disk.",
        "info": "Nothing is lost; the same command begins anew.",
    }
)
"""What is kept when a command is stopped, and what to do next; of all others ``BEGIN_ANEW`` holds."""


class Stopped(KeyboardInterrupt):
    """A stop that knows better than ``AFTER`` what was kept: its text says so."""


class Commands(TyperGroup):
    """Commands that end with a sentence, whatever ends them."""

    def invoke(self, ctx: Any) -> Any:
        """Runs the command that was asked for."""
        with _told_to_stop() as told:
            try:
                with swallowed_interrupts_again():
                    return super().invoke(ctx)
            except KeyboardInterrupt as stop:
                raise _stopped(ctx, str(stop) if isinstance(stop, Stopped) else "") from None
            except (FairyringError, typer.Exit, typer.Abort, BrokenPipeError):
                raise
            except Exception as error:
                if _is_usage(error) or ctx.params.get("debug"):
                    raise
                if told.is_set():
                    raise _stopped(ctx, "") from error
                typer.echo(_sentence_on(error), err=True)
                raise typer.Exit(1) from error


def _stopped(ctx: Any, said: str) -> typer.Exit:
    """Says what was kept, and is what ends the command."""
    typer.echo(f"fairyring: stopped. {said or AFTER.get(ctx.invoked_subcommand, BEGIN_ANEW)}", err=True)
    return typer.Exit(INTERRUPTED)


@contextmanager
def _told_to_stop() -> Iterator[threading.Event]:
    """Whether Ctrl+C or SIGTERM came; both raise KeyboardInterrupt where a command does not handle them.

    It is remembered because what is raised need not arrive: an import it meets ends in a TypeError.
    """
    told = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield told
        return

    def interrupt(*_: object) -> None:
        told.set()
        raise KeyboardInterrupt

    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    for number, handler in before.items():
        # In the background a shell has Ctrl+C ignored, which stays so.
        if handler is not signal.SIG_IGN:
            signal.signal(number, interrupt)
    try:
        yield told
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _is_usage(error: Exception) -> bool:
    """Whether it is about how the command was written, which is shown by whoever runs it."""
    return any("ClickException" in kind.__name__ for kind in type(error).__mro__)


def _sentence_on(error: Exception) -> str:
    """What is said of an error nobody foresaw, once all about it is in a file to report it with."""
    what = f"An error in Fairyring itself ended this ({type(error).__name__}: {error!s:.200})."
    try:
        report = _report_on(error)
    except OSError:
        return f"fairyring: {what} Say --debug after fairyring to see where, and report that."
    return f"fairyring: {what} Please report it with {report}, or see it with: fairyring --debug …"


def _report_on(error: Exception) -> Path:
    """A file with what is needed to mend an error; it holds no file of the person's but their paths."""
    lines = [
        f"Fairyring {version()}, Python {platform.python_version()}, {platform.platform()}",
        " ".join(sys.argv),
        "",
        *traceback.format_exception(error),
    ]
    with tempfile.NamedTemporaryFile("w", prefix="fairyring-error-", suffix=".txt", delete=False) as file:
        file.write("\n".join(lines))
    return Path(file.name)
