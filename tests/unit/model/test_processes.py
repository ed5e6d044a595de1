"""Processes that work on tasks side by side."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import pytest

from fairyring.model.processes import worked_on

ROOT = Path(__file__).parents[3]
PARENT = """
from fairyring.model.processes import worked_on
from tests.unit.model.test_processes import announce
list(worked_on(announce, [60, 60], jobs=2))
"""


def announce(seconds: float) -> None:
    sys.stdout.write("up\n")
    sys.stdout.flush()
    time.sleep(seconds)


@pytest.mark.parametrize("jobs", [1, 2])
def test_every_task_is_worked_on(jobs: int) -> None:
    assert list(worked_on(abs, [-3, 1, -2], jobs=jobs)) == [3, 1, 2]


def test_a_process_that_is_ended_from_outside_ends_the_work() -> None:
    with pytest.raises(BrokenProcessPool):
        list(worked_on(os._exit, [1, 1], jobs=2))


def test_processes_whose_parent_is_killed_end_too() -> None:
    parent = subprocess.Popen([sys.executable, "-c", PARENT], cwd=ROOT, stdout=subprocess.PIPE)
    assert parent.stdout
    assert [parent.stdout.readline(), parent.stdout.readline()] == [b"up\n", b"up\n"]
    parent.kill()
    parent.wait()
    before = time.monotonic()
    # The pipe ends once nobody holds it open any more.
    assert parent.stdout.read() == b""
    assert time.monotonic() - before < 30
