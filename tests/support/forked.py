"""Servers forked from a process that has read all of Fairyring: a start costs a tenth of one from nothing.

What is served is the same; how the command itself starts is tested by `tests/faults` and `.ci`.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from fairyring.app.bench.serving import Server

_KNOWN = ["fairyring.app.cli", "fairyring.app.commands.serve", "fairyring.app.gateway.server"]


class Forked:
    """``fairyring`` with these words in a process of its own, as `subprocess.Popen` would have it."""

    def __init__(self, words: Sequence[str]) -> None:
        context = multiprocessing.get_context("forkserver")
        context.set_forkserver_preload(_KNOWN)
        given = (list(words), dict(os.environ), Path.cwd())
        self._process = context.Process(target=_command, args=given)
        self._process.start()

    @property
    def pid(self) -> int:
        """Its number."""
        assert self._process.pid is not None
        return self._process.pid

    def poll(self) -> int | None:
        """Its exit code; None while it runs."""
        return self._process.exitcode

    def wait(self, timeout: float | None = None) -> int:
        """Its exit code, once it has ended; raises TimeoutExpired."""
        self._process.join(timeout)
        if self._process.exitcode is None:
            raise subprocess.TimeoutExpired("fairyring", timeout or 0)
        return self._process.exitcode

    def send_signal(self, number: signal.Signals) -> None:
        """Sends it a signal."""
        os.kill(self.pid, number)

    def kill(self) -> None:
        """Ends it by SIGKILL."""
        self._process.kill()


def forked_server(project: Path) -> Server:
    """A server that is not started yet."""
    return Server(project, run=Forked)


def _command(words: list[str], environment: dict[str, str], folder: Path) -> None:
    os.environ.clear()
    os.environ.update(environment)
    os.chdir(folder)
    sys.argv = ["fairyring", *words]
    signal.signal(signal.SIGINT, signal.default_int_handler)
    from fairyring.app.cli import main

    main()
