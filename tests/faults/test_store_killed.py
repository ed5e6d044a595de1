"""Processes that write to one project are killed, run side by side, or die in mid-import."""

import os
import signal
import sqlite3
import subprocess
import sys
import time
from itertools import product
from pathlib import Path

import cv2
import numpy as np
import pytest

from fairyring.storage.contents import load_annotations
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import history
from fairyring.storage.project import create_project, open_project

ROOT = Path(__file__).parents[2]

WRITER = """
import sys
from pathlib import Path
from fairyring.storage.journal import Derived, commit
from fairyring.storage.project import open_project
from fairyring.storage.records import Accepted, Cap, Edit

folder, name, count = Path(sys.argv[1]), sys.argv[2], int(sys.argv[3])
cap = Cap(visible=[[10.0, 10.0, 30.0, 10.0, 30.0, 30.0]])
with open_project(folder) as project:
    for number in range(count):
        uids = [f"{name} {number} {k}" for k in range(3)]
        edits = [Edit(id=uid, annotation=uid, image=1, base=0, cap=cap) for uid in uids]
        outcomes = commit(project, [Derived(edit=edit) for edit in edits], user=name)
        assert all(isinstance(outcome, Accepted) for outcome in outcomes), outcomes
        print(number, flush=True)
"""

IMPORTER = """
import os, signal, sys
from pathlib import Path
from fairyring.storage.importing import paths, storing
from fairyring.storage.project import open_project

def die(*_, **__):
    os.kill(os.getpid(), signal.SIGKILL)

module, name = sys.argv[3].split(".")
setattr({"paths": paths, "storing": storing}[module], name, die)
with open_project(Path(sys.argv[1])) as project:
    paths.import_paths(project, [Path(sys.argv[2])])
"""


def start(script, *arguments):
    return subprocess.Popen(
        [sys.executable, "-c", script, *map(str, arguments)], cwd=ROOT, stdout=subprocess.PIPE, text=True
    )


def photo(path):
    path.parent.mkdir(parents=True, exist_ok=True)
    assert cv2.imwrite(str(path), np.full((80, 100, 3), 99, np.uint8))
    return path


@pytest.fixture
def folder(tmp_path):
    with create_project(tmp_path / "beds") as project:
        import_paths(project, [photo(tmp_path / "bed.png")])
    return tmp_path / "beds"


def stored(folder):
    with open_project(folder) as project, project.read() as connection:
        return {annotation.uid for annotation in load_annotations(connection, 1)}


def is_sound(folder):
    with sqlite3.connect(folder / "project.db") as connection:
        return (
            connection.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
            and connection.execute("PRAGMA foreign_key_check").fetchall() == []
        )


@pytest.mark.parametrize("patience", [0.0, 0.02, 0.05])
def test_no_acknowledged_edit_is_lost_to_kill_9(folder, patience):
    writer = start(WRITER, folder, "ann", 100_000)
    assert writer.stdout is not None
    acknowledged = [writer.stdout.readline() for _ in range(10)]
    time.sleep(patience)
    os.kill(writer.pid, signal.SIGKILL)
    acknowledged += writer.stdout.readlines()
    writer.wait()
    numbers = [int(line) for line in acknowledged if line.endswith("\n")]
    kept = stored(folder)
    assert {f"ann {number} {k}" for number in numbers for k in range(3)} <= kept
    # A change set is there as a whole or not at all, and at most the one under way was not acknowledged.
    assert len(kept) in (3 * len(numbers), 3 * len(numbers) + 3)
    assert is_sound(folder)


def test_two_processes_write_at_once_and_both_get_through(folder):
    writers = [start(WRITER, folder, name, 25) for name in ("ann", "bob")]
    for writer in writers:
        writer.communicate(timeout=120)
        assert writer.returncode == 0
    names = product(("ann", "bob"), range(25), range(3))
    assert stored(folder) == {f"{name} {number} {k}" for name, number, k in names}
    with open_project(folder) as project, project.read() as connection:
        assert [entry.user for entry in history(connection, "bob 24 2")] == ["bob"]
        assert connection.exec_driver_sql("SELECT caps FROM image").scalar() == 150


@pytest.mark.parametrize(
    "moment", ["paths.take_in", "paths.store", "storing.enter_annotations", "storing._set_statuses"]
)
def test_an_import_that_is_killed_leaves_nothing_and_can_be_repeated(folder, tmp_path, moment):
    """While it reads, and before, between and after its rows; test_import_killed.py has photos in place."""
    new = photo(tmp_path / "new" / "bed_2.png")
    importer = start(IMPORTER, folder, new, moment)
    importer.communicate(timeout=120)
    assert importer.returncode == -signal.SIGKILL
    with open_project(folder) as project:
        with project.read() as connection:
            assert connection.exec_driver_sql("SELECT count(*) FROM image").scalar() == 1
        assert import_paths(project, [new]).images == 1
    assert is_sound(folder)
    assert (folder / "images" / "bed_2.png").read_bytes() == new.read_bytes()


def test_a_photo_placed_by_an_import_that_was_killed_before_its_commit_is_taken_over(folder, tmp_path):
    new = photo(tmp_path / "new" / "bed_2.png")
    (folder / "images" / "bed_2.png").write_bytes(new.read_bytes())
    with open_project(folder) as project:
        assert import_paths(project, [new]).images == 1
