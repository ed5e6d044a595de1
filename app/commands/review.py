"""``fairyring review``: what people marked against what was predicted, over a whole project."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fairyring.app.commands.files import write_bytes
from fairyring.app.commands.progress import steps_shown
from fairyring.app.commands.project import ProjectFolder
from fairyring.app.commands.rows import AsJson, print_rows

if TYPE_CHECKING:
    from fairyring.app.review.figures import Review
    from fairyring.storage.project import Project


def review(
    folder: ProjectFolder,
    *,
    report: Annotated[
        Path | None, typer.Option(metavar="OUT.html", help="Write a page with plots and pictures as well.")
    ] = None,
    sure: Annotated[
        bool, typer.Option("--sure", help="Leave out doubtful caps, and marks that hardly tell a centre.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Compare the caps that people marked with the latest predictions: CDR, its floor, and what was missed.

    Images that nobody has worked on do not count; they are named. The floor is the CDR that the marks have by
    themselves, from how many points they have and where on the rim these lie.

    Example: `fairyring review beds --report review.html`
    """
    from fairyring.app.review.figures import figures_of, review_of
    from fairyring.storage.project import open_project

    with open_project(folder) as project:
        with steps_shown() as progress:
            found = review_of(project, only_sure=sure, progress=progress)
        if report is not None:
            _write_report(project, found, report)
    figures = figures_of(found)
    if as_json:
        typer.echo(json.dumps(figures))
        return
    print_rows(f"review of {folder}", [_line("all", figures), *_group_lines(figures)], as_json=False)
    if found.untouched:
        typer.echo(f"{len(found.untouched)} images that nobody has worked on are not counted.", err=True)


def _write_report(project: Project, found: Review, out: Path) -> None:
    from fairyring.app.report.page import page_of

    write_bytes(page_of(project, found).encode(), out)
    typer.echo(f"Wrote {out}", err=True)


def _group_lines(figures: dict[str, Any]) -> list[dict[str, Any]]:
    return [
        _line(f"{kind}: {value.replace('_', ' ')}", some)
        for kind, values in figures["groups"].items()
        for value, some in values.items()
    ]


def _line(name: str, figures: dict[str, Any]) -> dict[str, Any]:
    return {
        "caps": name,
        "CDR, %": _rounded(figures["cdr"]["mean"]),
        "floor, %": _rounded(figures["floor"]["cdr_mean"]),
        "px": _rounded(figures["px"]["mean"]),
        **{name: figures[name] for name in ("matched", "missed", "extra", "doubtful", "unsure_marks")},
    }


def _rounded(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f}"
