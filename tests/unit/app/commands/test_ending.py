"""How commands end that are stopped, or that meet an error nobody foresaw."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fairyring.app.cli import app
from fairyring.app.commands import info, progress
from fairyring.storage.project import create_project
from tests.strangers.bed import photo, write
from tests.strangers.coco import caps, document, image

FAIRYRING = [sys.executable, "-c", "from fairyring.app.cli import main; main()"]


@pytest.fixture
def project(tmp_path):
    create_project(tmp_path / "beds").close()
    return tmp_path / "beds"


@pytest.fixture
def many_photos(tmp_path):
    """A folder whose import takes long enough to be stopped."""
    for number in range(400):
        photo(tmp_path / "photos" / f"bed_{number}.jpg", moved=number / 40)
    images = [image(number + 1, f"bed_{number}.jpg") for number in range(400)]
    entries = [entry for number in range(400) for entry in caps(number + 1, first=2 * number + 1)]
    write(tmp_path / "photos" / "labels.json", document(images, entries))
    return tmp_path / "photos"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_import_that_is_stopped_says_what_was_kept(project, many_photos, number):
    running = subprocess.Popen(
        [*FAIRYRING, "import", str(project), str(many_photos)], stderr=subprocess.PIPE, text=True
    )
    time.sleep(2.5)
    running.send_signal(number)
    _, said = running.communicate(timeout=120)
    stored = int(CliRunner().invoke(app, ["info", str(project)]).stdout.split(" images")[0].rsplit(" ", 1)[1])
    assert running.returncode == 130
    assert stored in (0, 400)
    expected = (
        "Everything is stored: 400 images" if stored else "Nothing was changed; the same command begins anew."
    )
    assert f"fairyring: stopped. {expected}" in said
    assert "Traceback" not in said


def test_an_error_nobody_foresaw_ends_in_a_sentence_with_a_file_to_report(project, monkeypatch):
    def break_down(*_: object) -> None:
        raise ZeroDivisionError("unheard of")

    monkeypatch.setattr(info, "_lines", break_down)
    done = CliRunner().invoke(app, ["info", str(project)])
    assert done.exit_code == 1
    assert "An error in Fairyring itself ended this (ZeroDivisionError: unheard of)." in done.stderr
    report = Path(done.stderr.split("report it with ")[1].split(",")[0])
    text = report.read_text()
    report.unlink()
    assert "break_down" in text
    assert text.startswith("Fairyring 0.")
    done = CliRunner().invoke(app, ["--debug", "info", str(project)])
    assert isinstance(done.exception, ZeroDivisionError)


def test_wrong_use_is_no_error_of_fairyring(project):
    done = CliRunner().invoke(app, ["info", str(project), "--wrong"])
    assert done.exit_code == 2
    assert "No such option" in done.stderr


def test_without_a_terminal_progress_is_a_line_every_few_seconds(monkeypatch, capsys):
    now = [100.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    with progress.shown_on_stderr() as report:
        for done in range(12):
            report(done, 12, "Copying photos")
            now[0] += 1.0
    assert capsys.readouterr().err.splitlines() == ["Copying photos: 5 of 12", "Copying photos: 10 of 12"]


def test_a_variable_that_is_wrong_is_named(project):
    env = os.environ | {"FAIRYRING_PORT": "eighty"}
    done = subprocess.run(
        [*FAIRYRING, "serve", str(project)], env=env, capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert "FAIRYRING_PORT" in done.stderr
