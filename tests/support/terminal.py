"""The commands as somebody types them, and the sentence they stop with."""

from __future__ import annotations

from pathlib import Path

from click.testing import Result
from typer.testing import CliRunner

from fairyring.app.cli import app
from fairyring.model.errors import FairyringError


def fairyring(*words: object) -> Result:
    return CliRunner().invoke(app, [str(word) for word in words])


def train(source: Path, out: Path, *options: object) -> Result:
    return fairyring("train", source, "--out", out, "--device", "cpu", "--workers", 0, *options)


def sentence(done: Result) -> str:
    assert isinstance(done.exception, FairyringError), done.output
    return str(done.exception)
