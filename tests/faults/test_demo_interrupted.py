"""A demo that is interrupted, however that happens, is gone on with by the same command."""

from __future__ import annotations

import os
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from fairyring.app.demo.begun import beds_of
from tests.support.how_much import FORM

COUNT = 3
DEMO = [sys.executable, "-c", "from fairyring.app.cli import main; main()", "demo"]


def is_rendering(folder: Path) -> bool:
    """A bed is there, but not yet all."""
    return any((beds_of(folder) / ".parts").glob("*.json"))


def is_predicting(folder: Path) -> bool:
    return bool(rows(folder, "prediction"))


def rows(folder: Path, table: str) -> set[tuple[object, ...]]:
    if not (folder / "project.db").exists():
        return set()
    with closing(sqlite3.connect(folder / "project.db")) as database:
        try:
            return set(database.execute(f"SELECT * FROM {table}"))
        except sqlite3.OperationalError:
            return set()


def interrupted(folder: Path, *, when: Callable[[Path], bool], by: signal.Signals) -> int:
    """Ends the command, and all its processes, as soon as ``when`` holds; returns its exit code."""
    running = subprocess.Popen([*DEMO, str(folder), "--count", str(COUNT)], start_new_session=True)
    deadline = time.monotonic() + 120
    while not when(folder):
        assert running.poll() is None, "ended before it was interrupted"
        assert time.monotonic() < deadline
        time.sleep(0.005)
    os.killpg(running.pid, by)
    return running.wait(timeout=60)


WAYS = [
    (signal.SIGKILL, is_rendering, -9),
    (signal.SIGTERM, is_predicting, 130),
    (signal.SIGINT, is_rendering, 130),
    (signal.SIGKILL, is_predicting, -9),
]


@pytest.mark.parametrize(("by", "when", "code"), WAYS[:2] if FORM == "short" else WAYS)
def test_an_interrupted_demo_is_gone_on_with(
    tmp_path: Path, by: signal.Signals, when: Callable[[Path], bool], code: int
) -> None:
    folder = tmp_path / "demo"
    assert interrupted(folder, when=when, by=by) == code
    predictions = rows(folder, "prediction")
    if when is is_rendering:
        whole = next((beds_of(folder) / ".parts").glob("*.json"))
        bed = beds_of(folder) / "images" / f"bed_{whole.stem}.jpg"
        # Rendered again it would lack this.
        bed.write_bytes(bed.read_bytes() + b"kept")

    # Whatever count is asked for now: it is the demo that was begun.
    done = subprocess.run([*DEMO, str(folder)], capture_output=True, text=True, check=True)

    assert f"Made {folder}" in done.stderr
    assert len(rows(folder, "image")) == COUNT
    assert rows(folder, "prediction") > predictions
    kept = [photo for photo in (folder / "images").iterdir() if photo.read_bytes().endswith(b"kept")]
    assert len(kept) == (when is is_rendering)
    assert not (folder / "unfinished").exists()
