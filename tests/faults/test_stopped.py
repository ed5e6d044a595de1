"""Every command that takes a while, stopped in the middle by Ctrl+C or by SIGTERM.

Each says what was kept and what to do next, leaves nothing half-written, and what it says to do next works.
"""

from __future__ import annotations

import re
import shutil
import signal
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from fairyring.app.bench.projects import Bed, write_labels
from fairyring.app.bench.serving import free_port
from fairyring.storage.backup import back_up
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import create_project, open_project
from tests.support.descendants import children_of, is_running
from tests.support.how_much import by_form
from tests.support.signalled import STOPPED, WITHIN_S, listens, started, wait_until

pytestmark = pytest.mark.timeout(900)
ANEW = "Nothing was written; the same command begins anew."
OUTLINES_KEPT = "Nothing was written; whole outlines found so far are kept. The same command goes on."
UNCHANGED = "Nothing was changed; the same command begins anew."


@dataclass(frozen=True, kw_only=True)
class Errand:
    """A command, given in a folder with the projects ``beds`` and ``fresh``, a backup and labelled photos."""

    command: str
    says: str
    """A pattern of what is said."""
    leaves: tuple[str, ...] = ()
    """What else may lie in the folder afterwards."""
    then: str | None = None
    """What it says to do next; None for the same again."""
    begun: Callable[[Path], bool] = lambda _folder: True
    """Whether it is in the middle, once it listens to signals."""
    in_short_form: bool = True
    tried_again: bool = True


def lies_there(name: str) -> Callable[[Path], bool]:
    return lambda folder: (folder / name).exists()


SYNTH = "synth rendered --count 3 --seed 1 --jobs 1"
TRAIN = "train beds --out run --iterations 1 --device cpu --workers 0"
ERRANDS = (
    Errand(command="import fresh photos", says=UNCHANGED),
    Errand(command="import fresh photos --link", says=UNCHANGED),
    Errand(command="export beds out", says=OUTLINES_KEPT),
    Errand(command="export beds out --labels-only", says=OUTLINES_KEPT),
    Errand(command="review beds --report review.html", says=OUTLINES_KEPT),
    Errand(command="evaluate masks photos/labels.json photos/labels.json", says=ANEW),
    Errand(command="evaluate centres photos/labels.json photos/labels.json", says=ANEW),
    Errand(command="contour photos/labels.json --out centres.json", says=ANEW),
    Errand(command="priors photos/labels.json --out priors.json", says=ANEW),
    Errand(command="backup beds again", says=ANEW),
    Errand(command="restore saved again", says=ANEW),
    Errand(
        command="predict beds --method hough",
        says=r"Stopped; predicted and kept: \d+\. The same command goes on\.|" + ANEW,
    ),
    Errand(command="predict photos --method hough --out seen.json", says=ANEW),
    Errand(
        command=SYNTH,
        says=r"The beds rendered so far are kept; the same command with --resume goes on\.",
        leaves=("rendered",),
        then=f"{SYNTH} --resume",
        begun=lies_there("rendered/.parts"),
    ),
    Errand(
        command="demo made --count 1",
        says=r"the same command goes on",
        leaves=("made",),
    ),
    Errand(
        command=TRAIN,
        says="Stopped before the first iteration was done; nothing is lost by starting anew.|" + ANEW,
        leaves=("run",),
    ),
    Errand(command="bench scene --quick", says=ANEW),
    Errand(command="bench evaluation --quick", says=ANEW),
    *(
        Errand(command=f"bench {bench} --quick", says=ANEW, in_short_form=False)
        for bench in ("commands", "contour", "fit", "people")
    ),
    *(
        # Chromium, which they need later, cannot do with paths as long as those of a test.
        Errand(command=f"bench {bench} --quick", says=ANEW, in_short_form=False, tried_again=False)
        for bench in ("store", "page", "editor", "review", "desk")
    ),
)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder in which the errands are run, to be copied."""
    folder = tmp_path_factory.mktemp("made")
    beds = [Bed(name=f"bed_{i:02}.jpg", width=1200, height=900, caps=300, vertices=24) for i in range(14)]
    labels = write_labels(folder / "photos", beds)
    create_project(folder / "fresh").close()
    with create_project(folder / "beds") as project:
        import_paths(project, [labels])
        back_up(project, folder / "saved")
    return folder


@pytest.fixture
def folder(made: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(made, tmp_path / "here"))


def lying_in(folder: Path) -> set[str]:
    """What is in a folder, also within its projects; but for what SQLite keeps beside an open database."""
    return {
        str(path.relative_to(folder))
        for path in folder.rglob("*")
        if path.suffix not in (".db-wal", ".db-shm") and ".cache" not in path.parts
    }


def errands() -> list[Any]:
    """In the short form every command is stopped once, by Ctrl+C and by SIGTERM in turn; else by both."""
    signals = (signal.SIGINT, signal.SIGTERM)
    return [
        pytest.param(errand, number, id=f"{errand.command}, {number.name}")
        for nth, errand in enumerate(ERRANDS)
        for number in by_form(
            short=signals[nth % 2 : nth % 2 + 1] if errand.in_short_form else (), usual=signals, long=signals
        )
    ]


@pytest.mark.parametrize(("errand", "number"), errands())
def test_a_command_that_is_stopped_says_what_was_kept(
    errand: Errand, number: signal.Signals, folder: Path
) -> None:
    before = lying_in(folder)
    running = started(folder, errand.command)
    wait_until(lambda: listens(running), running)
    wait_until(lambda: errand.begun(folder), running)
    helpers = children_of(running.pid)
    running.send_signal(number)
    _, said = running.communicate(timeout=WITHIN_S)
    assert running.returncode == STOPPED, said
    assert re.search(errand.says, said), said
    assert not [helper for helper in helpers if is_running(helper)]
    assert "Traceback" not in said
    left = {path for path in lying_in(folder) - before if path.split("/")[0] not in errand.leaves}
    assert left == set()
    assert lying_in(folder.parent / "tmp") == set()
    if not errand.tried_again:
        return
    again = started(folder, errand.then or errand.command)
    _, said = again.communicate(timeout=600)
    assert again.returncode == 0, said


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=lambda number: number.name)
def test_a_server_that_is_stopped_says_that_edits_are_on_disk(number: signal.Signals, folder: Path) -> None:
    for _ in range(2):  # the second time because what it says to do next is nothing: it can be served again
        running = started(folder, f"serve beds --port {free_port()}")
        assert running.stderr is not None
        line = running.stderr.readline()
        assert "beds is open at http://localhost:" in line
        running.send_signal(number)
        _, said = running.communicate(timeout=WITHIN_S)
        assert running.returncode == STOPPED, said
        assert "The project is closed; every edit that was said to be saved is on disk." in said
        assert "Traceback" not in said
    with open_project(folder / "beds") as project, project.read():
        assert not project.read_only
