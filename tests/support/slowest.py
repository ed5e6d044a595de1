"""The input that took longest, of many."""

from __future__ import annotations

import contextlib
import logging
import time
from collections.abc import Iterator

log = logging.getLogger(__name__)
MOST_S = 1.0
"""Longest time an input may take, of the processor."""


class Slowest:
    """The input that took longest, in seconds of the processor."""

    def __init__(self) -> None:
        self.taken, self.given = 0.0, ""

    @contextlib.contextmanager
    def watched(self, given: object) -> Iterator[None]:
        begun = time.process_time()
        yield
        taken = time.process_time() - begun
        if taken > self.taken:
            self.taken, self.given = taken, repr(given)[:2000]

    def judge(self, what: str, count: int, *, most_s: float = MOST_S) -> None:
        log.info("%s: %d inputs, the slowest %.2f s", what, count, self.taken)
        assert self.taken < most_s, self.given
