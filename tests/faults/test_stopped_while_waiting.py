"""Commands that wait for a database as long as another program holds it, and are told to stop meanwhile.

They are done too quickly to be stopped in the middle otherwise. Each either undoes what it was at and says
so, or says what it has done.
"""

from __future__ import annotations

import shutil
import signal
import sqlite3
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import pytest

from fairyring.app.bench.projects import Bed, write_labels
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.project import create_project
from fairyring.storage.taken_out import take_out
from tests.support.how_much import by_form
from tests.support.signalled import STOPPED, WITHIN_S, listens, started, wait_until

pytestmark = pytest.mark.timeout(900)
SQUARE = [10.0, 10.0, 30.0, 10.0, 30.0, 30.0, 10.0, 30.0]
UNCHANGED = "Nothing was changed; the same command begins anew."
SIGNALS = (signal.SIGINT, signal.SIGTERM)


@dataclass(frozen=True, kw_only=True)
class Errand:
    """A command, what it says when it was undone, and what when it was done all the same."""

    command: str
    undone: str = UNCHANGED
    done: str
    database: str = "locked/project.db"


ERRANDS = (
    Errand(command="take-out locked bed_0.jpg", done="Undo it with: fairyring put-back locked"),
    Errand(command="put-back locked", done=""),
    Errand(command="relink locked moved", done=""),
    Errand(
        command="runs compare locked first second",
        undone="Nothing was written; whole outlines found so far are kept. The same command goes on.",
        done="",
    ),
    Errand(
        command="init made --db sqlite:///held.db",
        undone="If no project was made, the same command goes on.",
        done="Made made. Next: fairyring import made PHOTOS",
        database="held.db",
    ),
)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a project of which one image was taken out and whose linked photos were moved."""
    folder = tmp_path_factory.mktemp("waiting")
    beds = [Bed(name=f"bed_{nth}.jpg", width=320, height=240, caps=12, vertices=12) for nth in range(3)]
    labels = write_labels(folder / "photos", beds)
    with create_project(folder / "locked") as project:
        import_paths(project, [labels], link=True)
        for name in ("first", "second"):

            def predict(connection, name=name):
                run = add_run(connection, name=name, kind="network")
                said = NewPrediction(visible=[SQUARE], score=0.75)
                add_predictions(connection, run_id=run.id, image_id=1, predictions=[said])

            project.write(predict)
        take_out(project, [2], user="ann")
    (folder / "photos").rename(folder / "moved")
    sqlite3.connect(folder / "held.db").close()
    return folder


def errands() -> list[object]:
    return [
        pytest.param(errand, number, id=f"{errand.command}, {number.name}")
        for nth, errand in enumerate(ERRANDS)
        for number in by_form(short=SIGNALS[nth % 2 : nth % 2 + 1], usual=SIGNALS, long=SIGNALS)
    ]


@pytest.mark.parametrize(("errand", "number"), errands())
def test_a_command_told_to_stop_while_it_waits_undoes_all_or_does_all(
    errand: Errand, number: signal.Signals, made: Path, tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(made, tmp_path / "here"))
    with closing(sqlite3.connect(folder / errand.database, isolation_level=None)) as other:
        other.execute("BEGIN EXCLUSIVE" if errand.database == "held.db" else "BEGIN IMMEDIATE")
        running = started(folder, errand.command)
        wait_until(lambda: listens(running), running)
        running.send_signal(number)
        other.execute("ROLLBACK")
    _, said = running.communicate(timeout=WITHIN_S)
    assert "Traceback" not in said
    if running.returncode == STOPPED:
        assert f"fairyring: stopped. {errand.undone}" in said
        again = started(folder, errand.command)
        _, said = again.communicate(timeout=WITHIN_S)
        assert again.returncode == 0, said
    else:
        assert running.returncode == 0, said
        assert errand.done in said
