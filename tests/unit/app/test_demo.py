"""The demo's note of what it was begun with, and what asks for it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from fairyring.app.demo.begun import Begun, begun, begun_in
from fairyring.app.demo.making import make_demo
from fairyring.storage.errors import StoreError
from fairyring.storage.project import create_project

WANTED = Begun(count=3, seed=5)


def test_what_was_begun_first_is_gone_on_with(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt), begun(tmp_path / "demo", WANTED):
        raise KeyboardInterrupt
    assert begun_in(tmp_path / "demo") == WANTED
    with begun(tmp_path / "demo", Begun(count=9, seed=9)) as demo:
        assert demo == WANTED
    assert begun_in(tmp_path / "demo") is None
    assert list((tmp_path / "demo").iterdir()) == []


def test_two_processes_do_not_make_one_demo(tmp_path: Path) -> None:
    with (
        begun(tmp_path, WANTED),
        pytest.raises(StoreError, match="being made by another process"),
        begun(tmp_path, WANTED),
    ):
        pass


def test_a_damaged_note_names_the_remedy(tmp_path: Path) -> None:
    (tmp_path / "unfinished").mkdir()
    (tmp_path / "unfinished" / "begun.json").write_text("{")
    with pytest.raises(StoreError, match=f"delete {tmp_path} to start afresh"):
        begun_in(tmp_path)


def test_a_project_that_is_no_demo_is_refused_and_left_alone(tmp_path: Path) -> None:
    create_project(tmp_path / "beds").close()
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(StoreError, match="is a Fairyring project already"):
        make_demo(tmp_path / "beds", count=1, seed=1)
    assert sorted(tmp_path.rglob("*")) == before


def test_a_demo_that_is_there_is_told_of_without_loading_what_makes_one(tmp_path: Path) -> None:
    create_project(tmp_path / "demo").close()
    script = (
        f"import sys; sys.argv = ['fairyring', 'demo', {str(tmp_path / 'demo')!r}]\n"
        "from fairyring.app.cli import main\n"
        "try: main()\n"
        "except SystemExit: print(*{name.split('.')[0] for name in sys.modules})"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert "is there already" in done.stderr
    assert {"torch", "cv2", "numpy", "viser", "matplotlib"}.isdisjoint(done.stdout.split())
