"""Commands as processes of their own, to be told by signals to stop."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

from fairyring.app.bench.serving import FAIRYRING

STOPPED = 130
WITHIN_S = 120
"""A busy machine takes its time to begin and to end."""


def started(folder: Path, command: str) -> subprocess.Popen[str]:
    """A command at work in a folder; what it puts aside goes to ``tmp`` beside that."""
    (folder.parent / "tmp").mkdir(exist_ok=True)
    return subprocess.Popen(
        [*FAIRYRING, *command.split()],
        cwd=folder,
        env=os.environ | {"TMPDIR": str(folder.parent / "tmp")},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )


def wait_until(true: Callable[[], bool], running: subprocess.Popen[str]) -> None:
    """Waits for what is to become true while the command runs."""
    deadline = time.monotonic() + WITHIN_S
    while not true():
        assert running.poll() is None, f"It ended by itself: {running.communicate()[1]}"
        assert time.monotonic() < deadline, "It did not begin."
        time.sleep(0.02)


def listens(running: subprocess.Popen[str]) -> bool:
    """Whether the process answers SIGTERM itself, as a command does once it is at work."""
    status = Path(f"/proc/{running.pid}/status").read_text()
    caught = int(re.findall(r"SigCgt:\s+(\w+)", status)[0], 16)
    return bool(caught >> (signal.SIGTERM - 1) & 1)
