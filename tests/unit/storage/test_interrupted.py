"""Ctrl+C while a transaction is under way: what follows knows whether it was stored."""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from fairyring.storage.folder import DATABASE
from tests.support.categories import category_names, insert_category


@contextmanager
def ctrl_c_after(seconds: float) -> Iterator[None]:
    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_nothing_is_stored_of_a_transaction_that_ctrl_c_ends(project):
    def slowly(connection):
        insert_category("half")(connection)
        time.sleep(1)

    with ctrl_c_after(0.2), pytest.raises(KeyboardInterrupt):
        project.write(slowly)
    assert "half" not in category_names(project.folder / DATABASE)
    project.write(insert_category("whole"))
    assert "whole" in category_names(project.folder / DATABASE)
