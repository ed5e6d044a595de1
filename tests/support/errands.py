"""What a worker can be asked for in tests: functions that another process finds by their names."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

from fairyring.model.errors import FairyringError


def die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def die_the_first_time(seen: Path) -> str:
    if not seen.exists():
        seen.touch()
        die()
    return "done"


def wait_for(go: Path) -> None:
    while not go.exists():
        time.sleep(0.01)


def note(name: str, notes: Path) -> None:
    with notes.open("a") as file:
        file.write(f"{name}\n")


def refuse(why: str) -> None:
    raise FairyringError(why)
