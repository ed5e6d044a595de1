"""How commands end that are stopped, or that meet an error nobody foresaw."""

import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fairyring.app.bench.serving import FAIRYRING
from fairyring.app.cli import app
from fairyring.app.commands import info, progress
from fairyring.storage.project import create_project


@pytest.fixture
def project(tmp_path):
    create_project(tmp_path / "beds").close()
    return tmp_path / "beds"


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


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=lambda number: number.name)
def test_a_stop_that_turned_into_another_error_is_a_stop(project, monkeypatch, number):
    # A shell has Ctrl+C ignored by what it runs in the background, these tests perhaps.
    before = signal.signal(number, signal.default_int_handler)

    def imported_meanwhile(*_: object) -> None:
        try:
            signal.raise_signal(number)
        except KeyboardInterrupt:
            raise TypeError("expected a message argument") from None

    monkeypatch.setattr(info, "_lines", imported_meanwhile)
    done = CliRunner().invoke(app, ["info", str(project)])
    signal.signal(number, before)
    assert done.exit_code == 130
    assert done.stderr == "fairyring: stopped. Nothing is lost; the same command begins anew.\n"


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


def test_work_that_cannot_say_how_far_it_is_says_how_long_it_has_been_at_it(monkeypatch, capsys):
    monkeypatch.setattr(progress, "EVERY_S", 0.02)
    with progress.time_told("Comparing masks"):
        time.sleep(0.5)
    said = capsys.readouterr().err.splitlines()
    assert len(said) > 1
    assert set(said) <= {"Comparing masks: 0 s", "Comparing masks: 1 s"}


def test_a_variable_that_is_wrong_is_named(project):
    env = os.environ | {"FAIRYRING_PORT": "eighty"}
    done = subprocess.run(
        [*FAIRYRING, "serve", str(project)], env=env, capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert "FAIRYRING_PORT" in done.stderr
