"""Folders that are there whole or not at all."""

from __future__ import annotations

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from fairyring.storage.errors import StoreError
from fairyring.storage.whole_folders import clear_leftovers, made_whole, temporary_folder

MAKING = """
import sys, time
from pathlib import Path
from fairyring.storage.whole_folders import made_whole
with made_whole(Path(sys.argv[1])) as folder:
    (folder / "half").write_text("half")
    print("making", flush=True)
    time.sleep(60)
"""


def test_the_folder_appears_with_all_that_is_in_it(tmp_path: Path) -> None:
    with made_whole(tmp_path / "out") as folder:
        (folder / "file").write_text("content")
        assert not (tmp_path / "out").exists()
    assert [path.name for path in tmp_path.iterdir()] == ["out"]
    assert (tmp_path / "out" / "file").read_text() == "content"


def test_what_fails_leaves_nothing_behind(tmp_path: Path) -> None:
    def make() -> None:
        with made_whole(tmp_path / "out") as folder:
            (folder / "file").write_text("content")
            raise KeyError

    with pytest.raises(KeyError):
        make()
    assert list(tmp_path.iterdir()) == []


def test_what_holds_something_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("mine")
    for target in (tmp_path, tmp_path / "mine"):
        with pytest.raises(StoreError, match="is not empty"), made_whole(target):
            raise AssertionError
    (tmp_path / "empty").mkdir()
    with made_whole(tmp_path / "empty"):
        pass


def test_what_a_killed_process_left_is_cleared_and_what_is_being_made_is_not(tmp_path: Path) -> None:
    making = [
        subprocess.Popen([sys.executable, "-c", MAKING, str(tmp_path / name)], stdout=subprocess.PIPE)
        for name in ("killed", "alive")
    ]
    for process in making:
        assert process.stdout is not None
        process.stdout.readline()
    making[0].kill()
    making[0].wait()
    assert len(list(tmp_path.iterdir())) == 2
    (tmp_path / ".fairyring-notes").mkdir()

    with made_whole(tmp_path / "other"):
        left = {path.name for path in tmp_path.iterdir()}
        assert len(left) == 3, "the one alive, the one made here, and what only looks alike"
    making[1].kill()
    making[1].wait()
    clear_leftovers(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {".fairyring-notes", "other"}


def test_folders_made_at_once_in_one_place_do_not_clear_each_other(tmp_path: Path) -> None:
    def make(number: int) -> None:
        for nth in range(30):
            with made_whole(tmp_path / f"{number}-{nth}") as folder:
                (folder / "file").touch()

    with ThreadPoolExecutor(4) as pool:
        list(pool.map(make, range(4)))
    made = list(tmp_path.iterdir())
    assert len(made) == 120
    assert all((folder / "file").exists() for folder in made)


def test_a_temporary_folder_is_gone_after_its_block(tmp_path: Path) -> None:
    with temporary_folder(tmp_path) as folder:
        (folder / "file").touch()
    assert list(tmp_path.iterdir()) == []
