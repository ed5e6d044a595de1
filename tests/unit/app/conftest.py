"""A small project, and a real server for it in a thread."""

from __future__ import annotations

import shutil
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import cv2
import numpy as np
import pytest
import uvicorn

from fairyring.app.gateway.access import Door
from fairyring.app.gateway.server import configure, make_app
from fairyring.app.live.workspace import Workspace
from fairyring.app.settings import Settings
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.project import Project, create_project, open_project
from tests.support.tab import until

HOSTILE = "<img src=x onerror=alert(1)>"
"""Appears as user name, run name and file name: must never be read as HTML."""


def circle(cx: float, cy: float, r: float, points: int = 40) -> list[list[float]]:
    """The outline of a circle."""
    angles = np.linspace(0, 2 * np.pi, points, endpoint=False)
    return [np.stack([cx + r * np.cos(angles), cy + r * np.sin(angles)], axis=1).ravel().tolist()]


@pytest.fixture(scope="session")
def made_once(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three photos of 160 × 120, the first with two predictions of a simulated run."""
    photos = tmp_path_factory.mktemp("photos")
    generator = np.random.default_rng(1)
    for name in ("bed_1", "bed_2", f"bed_3 {HOSTILE.replace('/', '')}"):
        pixels = generator.integers(0, 255, (120, 160, 3), dtype=np.uint8)
        _, encoded = cv2.imencode(".jpg", pixels)
        (photos / f"{name}.jpg").write_bytes(encoded.tobytes())
    folder = tmp_path_factory.mktemp("made") / "beds"
    with create_project(folder) as project:
        import_paths(project, [photos])
        project.write(_predict)
    return folder


def _predict(connection: object) -> None:
    run = add_run(connection, name=HOSTILE, kind="simulated")
    predictions = [
        NewPrediction(visible=circle(40, 40, 20), score=0.9, uid="left"),
        NewPrediction(visible=circle(110, 60, 25), score=0.8, uid="right"),
    ]
    add_predictions(connection, run_id=run.id, image_id=1, predictions=predictions)


@pytest.fixture
def project(made_once: Path, tmp_path: Path) -> Iterator[Project]:
    """A copy of the project, to do with as one likes."""
    with open_project(Path(shutil.copytree(made_once, tmp_path / "beds"))) as opened:
        yield opened


@pytest.fixture
def serve(project: Project) -> Iterator[Callable[..., int]]:
    """Starts servers for the project; each call returns a port."""
    with ExitStack() as running:
        yield lambda **settings: running.enter_context(served(project, **settings))


@pytest.fixture
def port(serve: Callable[..., int]) -> int:
    """Of a server whose project the test may change."""
    return serve()


@pytest.fixture(scope="session")
def shared_port(made_once: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[int]:
    """Of a server for tests that change nothing."""
    folder = tmp_path_factory.mktemp("shared") / "beds"
    with open_project(Path(shutil.copytree(made_once, folder))) as project, served(project) as port:
        yield port


@contextmanager
def served(project: Project, *, door: Door | None = None, **settings: object) -> Iterator[int]:
    """A real server in a thread."""
    listening = socket.create_server(("127.0.0.1", 0))
    given = Settings(**settings)
    server = uvicorn.Server(configure(make_app(Workspace(project, given), door=door)))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]}, daemon=True)
    thread.start()
    until(lambda: server.started, "the server")
    yield listening.getsockname()[1]
    server.should_exit = True
    thread.join(15)
    listening.close()
    assert not thread.is_alive(), "the server did not stop"
