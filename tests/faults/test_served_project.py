"""A project that is served: by one server at a time, which closes it when it ends."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import PIL.Image
import pytest

from fairyring.app.bench.serving import FAIRYRING, Server, served
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import create_project
from fairyring.storage.records import Accepted
from tests.support.descendants import children_of, is_running, words_of
from tests.support.kept import live_caps
from tests.support.tab import Tab, new_cap, until


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A project of one photo."""
    PIL.Image.fromarray(np.full((240, 320, 3), 90, np.uint8)).save(tmp_path / "bed_1.jpg")
    with create_project(tmp_path / "beds") as project:
        import_paths(project, [tmp_path / "bed_1.jpg"])
    return tmp_path / "beds"


def test_a_second_server_says_where_the_first_is(folder: Path) -> None:
    with served(folder) as first:
        second = subprocess.run(
            [*FAIRYRING, "serve", str(folder), "--port", str(Server(folder).port)],
            capture_output=True,
            text=True,
            check=False,
        )
    assert second.returncode == 1
    assert f"{folder} is served already at http://localhost:{first.port}" in second.stderr


@pytest.mark.parametrize("told", [signal.SIGINT, signal.SIGTERM])
def test_a_server_that_is_told_to_end_closes_the_project(folder: Path, told: signal.Signals) -> None:
    server = Server(folder)
    server.start()
    assert server.process is not None
    with Tab(server.port, image=1) as tab:
        tab.edit(new_cap(1))
    server.process.send_signal(told)
    assert server.process.wait(timeout=20) == 130
    assert sorted(path.name for path in folder.glob("project.db*")) == ["project.db"]


def workers_of(server: Server) -> list[int]:
    """The processes that compute for a server."""
    assert server.process is not None
    forking = [pid for pid in children_of(server.process.pid) if "forkserver" in words_of(pid)]
    return [worker for pid in forking for worker in children_of(pid)]


def test_a_killed_worker_costs_nobody_an_edit(folder: Path) -> None:
    with served(folder) as server, Tab(server.port, image=1) as tab:
        for number in range(4):
            (outcome,) = tab.edit(new_cap(1, uid=f"cap-{number}", edit=f"edit-{number}")).outcomes
            assert isinstance(outcome, Accepted)
            assert outcome.annotation.centre == pytest.approx((40, 40), abs=0.5)
            for pid in workers_of(server):
                os.kill(pid, signal.SIGKILL)
    assert len(live_caps(folder)) == 4


@pytest.mark.parametrize("ended", [Server.stop, Server.kill], ids=["Ctrl+C", "SIGKILL"])
def test_the_workers_end_with_their_server(folder: Path, ended: Callable[[Server], object]) -> None:
    server = Server(folder)
    server.start()
    with Tab(server.port, image=1) as tab:
        tab.edit(new_cap(1))
    workers = workers_of(server)
    assert len(workers) > 0
    ended(server)
    until(lambda: not any(map(is_running, workers)), "the workers to end")


def test_what_was_killed_in_the_middle_is_cleared_when_the_project_is_served(folder: Path) -> None:
    number = 32 * "0"
    left = [
        folder / "images" / f".fairyring-{number}" / "bed_2.jpg",
        folder / "cache" / "exports" / f".fairyring-{number}" / "coco.zip",
        folder / "cache" / "photos" / f"{number}-full.123-abcd",
    ]
    kept = [
        folder / "images" / "bed_1.jpg",
        folder / "cache" / "exports" / f"{number}.zip",
        folder / "cache" / "photos" / f"{number}-full.jpg",
    ]
    for file in left + kept[1:]:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(b"content")

    with served(folder):
        assert [file for file in left if file.exists()] == []
        assert [file for file in kept if not file.exists()] == []
    assert list(folder.rglob(".fairyring-*")) == []
