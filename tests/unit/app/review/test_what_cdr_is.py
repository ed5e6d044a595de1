"""CDR is told in the same words wherever it is told."""

from __future__ import annotations

from pathlib import Path

from typer.testing import CliRunner

from fairyring.app.cli import app
from fairyring.app.review.what_cdr_is import CDR, FLOOR

GUIDE = Path(__file__).parents[4] / "docs" / "guide.md"


def plain(text: str) -> str:
    return " ".join(text.replace("**", "").split())


def test_guide_and_commands_tell_it_in_the_same_words() -> None:
    guide = plain(GUIDE.read_text(encoding="utf-8"))
    assert CDR in guide
    assert FLOOR in guide
    of_review, of_centres = (
        plain(CliRunner().invoke(app, [*command, "--help"]).output)
        for command in (["review"], ["evaluate", "centres"])
    )
    assert f"{CDR} {FLOOR}" in of_review
    assert CDR in of_centres
