"""Faults of single items of a document, and what a reader does about them.

Every reader of a document goes through its items alike and differs in one thing only, the function that
hears of a fault: an import collects them (``faults.append``), an evaluation stops at the first (the function
raises), ``fairyring contour`` keeps the annotation with the fault as its refusal.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from msgspec import Struct

from fairyring.model.coco.ids import id_of
from fairyring.model.errors import FairyringError
from fairyring.model.json_values import shown


class Fault(Struct, frozen=True):
    """The reason why one item cannot be taken as it stands."""

    where: str
    """The item, for example ``annotation 12``."""
    reason: str
    """Why it cannot be taken, as a sentence."""


Report = Callable[[Fault], None]
"""Called with every fault; what it raises ends the reading."""


class Reported:
    """A block that reads one item: what is wrong with it is told to ``report`` in place of being raised.

    A class, since every annotation of a file goes through one, and a generator takes four times as long.
    """

    __slots__ = ("_report", "_where")

    def __init__(self, where: str, report: Report) -> None:
        self._where = where
        self._report = report

    def __enter__(self) -> None:
        pass

    def __exit__(self, _kind: object, error: BaseException | None, _traceback: object) -> bool:
        if not isinstance(error, FairyringError):
            return False
        self._report(Fault(self._where, str(error)))
        return True


def place_of(kind: str, entry: Any, index: int) -> str:
    """``annotation 12`` by its id; where it has none, ``annotation at place 3``, counted from 1."""
    own = id_of(entry.get("id")) if isinstance(entry, dict) else None
    return f"{kind} at place {index + 1}" if own is None else f"{kind} {shown(own)}"
