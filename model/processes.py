"""Processes that work on tasks side by side, and all end when the work does: done, stopped or killed."""

from __future__ import annotations

import itertools
import multiprocessing
import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import contextmanager
from typing import TypeVar

import cv2

Task = TypeVar("Task")
Result = TypeVar("Result")
AHEAD = 3
"""So many tasks for each process are handed over before it asks for them."""


def usable_cores() -> int:
    """How many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def worked_on(work: Callable[[Task], Result], tasks: Iterable[Task], *, jobs: int) -> Iterator[Result]:
    """What ``work`` makes of each task, in their order; with one job in this process, else in that many.

    Tasks are taken a few at a time, so that all of them need never be there at once.
    Raises BrokenProcessPool (a RuntimeError) where one of them is ended from outside.
    """
    if jobs == 1:
        yield from map(work, tasks)
        return
    waiting, handed_over = iter(tasks), deque[Future[Result]]()
    pool = ProcessPoolExecutor(jobs, multiprocessing.get_context("spawn"), initializer=_begin)
    try:
        while True:
            for task in itertools.islice(waiting, AHEAD * jobs - len(handed_over)):
                with _ctrl_c_held_back():
                    handed_over.append(pool.submit(work, task))
            if not handed_over:
                return
            yield handed_over.popleft().result()
    finally:
        pool.shutdown(cancel_futures=True)


@contextmanager
def _ctrl_c_held_back() -> Iterator[None]:
    """Processes started meanwhile never hear of Ctrl+C, which is their parent's to answer; it does, after."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin() -> None:
    cv2.setNumThreads(1)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """A parent that is killed tells nobody, and its processes would wait for tasks for ever."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
