"""How long work says how far it is."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[int, int, str], None]
"""Called with how many steps are done, of how many, and what is done now; what it raises ends the work."""


def silent(_done: int, _total: int, _what: str) -> None:
    """The progress of work that nobody watches."""
