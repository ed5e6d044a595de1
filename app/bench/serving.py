"""A project served in a process of its own, for benchmarks and tests; it may be killed and started again."""

from __future__ import annotations

import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol
from urllib.request import urlopen

START_S = 180.0
_AS_A_SHELL_STARTS_IT = """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)
from fairyring.app.cli import main
main()
"""
FAIRYRING = (sys.executable, "-c", _AS_A_SHELL_STARTS_IT)
"""The command, of this very Python. Ctrl+C ends it, also where a shell runs all this in the background."""


def free_port() -> int:
    """A port nobody listens on just now."""
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        return listening.getsockname()[1]


class Running(Protocol):
    """A process, as far as a server's is looked after; `subprocess.Popen` is one."""

    @property
    def pid(self) -> int: ...
    def poll(self) -> int | None: ...
    def wait(self, timeout: float | None = None) -> int: ...
    def send_signal(self, number: signal.Signals, /) -> None: ...
    def kill(self) -> None: ...


def as_a_shell_would(words: Sequence[str]) -> Running:
    """Starts ``fairyring`` with these words."""
    return subprocess.Popen([*FAIRYRING, *words])


@dataclass
class Server:
    """``fairyring serve``, at the same port every time it is started."""

    project: Path
    port: int = field(default_factory=free_port)
    process: Running | None = None
    run: Callable[[Sequence[str]], Running] = as_a_shell_would
    """Starts the command."""

    @property
    def url(self) -> str:
        """The page's address."""
        return f"http://127.0.0.1:{self.port}"

    def start(self) -> None:
        """Starts it and waits until it answers; ConnectionError if it does not."""
        serve = ["serve", str(self.project), "--port", str(self.port), "--no-token"]
        self.process = self.run(serve)
        deadline = time.monotonic() + START_S
        while not self._answers():
            if (code := self.process.poll()) is not None or time.monotonic() > deadline:
                ended = "no answer" if code is None else f"exit code {code}"
                raise ConnectionError(f"{self.project} could not be served: {ended}.")
            time.sleep(0.05)

    def kill(self) -> None:
        """Ends it as a power cut would, by SIGKILL."""
        assert self.process is not None, "it has been started"
        self.process.kill()
        self.process.wait()

    def stop(self) -> int:
        """Ends it as Ctrl+C would; returns the exit code."""
        assert self.process is not None, "it has been started"
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(timeout=20)

    def memory_mb(self) -> float:
        """Resident memory of the server's process."""
        assert self.process is not None, "it has been started"
        ps = ["ps", "-o", "rss=", "-p", str(self.process.pid)]
        return int(subprocess.check_output(ps, text=True)) / 1024

    def _answers(self) -> bool:
        try:
            with urlopen(f"{self.url}/healthz", timeout=1) as answer:
                return answer.status == 200
        except OSError:
            return False


@contextmanager
def served(project: Path) -> Iterator[Server]:
    """A server for as long as the ``with`` lasts."""
    server = Server(project)
    server.start()
    try:
        yield server
    finally:
        server.stop()
