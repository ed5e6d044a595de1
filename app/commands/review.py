"""``fairyring review``: what people marked against what was predicted, over a whole project."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fairyring.app.commands.agreement import agreement_lines
from fairyring.app.commands.files import named, write_bytes
from fairyring.app.commands.progress import steps_shown
from fairyring.app.commands.project import ProjectFolder
from fairyring.app.commands.rows import AsJson, print_rows
from fairyring.app.how_many import how_many

if TYPE_CHECKING:
    from fairyring.app.review.figures import Review
    from fairyring.model.evaluate.agreement import Agreement
    from fairyring.storage.project import Project


def review(
    folder: ProjectFolder,
    *,
    report: Annotated[
        Path | None, typer.Option(metavar="OUT.html", help="Write a page with plots and pictures as well.")
    ] = None,
    run: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="A run, by name or number; else the latest."),
    ] = None,
    against: Annotated[
        str | None, typer.Option(metavar="NAME", help="Another run, put beside it on the images both saw.")
    ] = None,
    second: Annotated[
        str | None,
        typer.Option(
            metavar="NAME|COCO.json",
            help="What another annotator labelled in the same photos: a run, or their file.",
        ),
    ] = None,
    images: Annotated[str, typer.Option(metavar="GLOB", help="Only images of these file names.")] = "*",
    sure: Annotated[
        bool, typer.Option("--sure", help="Leave out doubtful caps, and marks that hardly tell a centre.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Compare the caps that people marked with the latest predictions: CDR, its floor, and what was missed.

    Images that nobody has worked on do not count; they are named. The floor comes from caps that were marked
    again, else from how many points a mark has and where these lie. --report and --json also hold what
    reviewers said, with reasons, who and when.

    Example: `fairyring review beds --run after --against before --report review.html`
    """
    from msgspec import to_builtins

    from fairyring.app.review.figures import figures_of
    from fairyring.app.review.two_runs import side_by_side
    from fairyring.storage.project import open_project

    wanted = _Wanted(run=run, against=against, images=images, sure=sure)
    with open_project(folder) as project:
        found, before = _reviews(project, wanted)
        agreement = None if second is None else _agreement(project, second, images)
        if report is not None:
            _write_report(project, found, report, before, agreement)
    figures = figures_of(found)
    if agreement is not None:
        figures |= {"two_annotators": {"second": agreement[0], **to_builtins(agreement[1])}}
    if before is not None:
        figures |= {"side_by_side": side_by_side(before, found)}
    if as_json:
        typer.echo(json.dumps(figures))
        return
    lines = [_line("all", figures), *_group_lines(figures)]
    if before is not None:
        lines.insert(0, _line(f"before: {against}", figures_of(before)))
    print_rows(f"review of {folder}", lines, as_json=False)
    if agreement is not None:
        print_rows(f"annotations and {agreement[0]}", agreement_lines(agreement[1]), as_json=False)
    if found.untouched:
        count = how_many(len(found.untouched), "image")
        typer.echo(f"Not counted, as nobody has worked on them: {count}.", err=True)


@dataclass(frozen=True, kw_only=True)
class _Wanted:
    """What is to be reviewed."""

    run: str | None
    against: str | None
    images: str
    sure: bool


def _reviews(project: Project, wanted: _Wanted) -> tuple[Review, Review | None]:
    """The review, and that of the other run on the same images."""
    from fairyring.app.review.figures import review_of
    from fairyring.app.review.two_runs import reviews_of_both
    from fairyring.storage.errors import StoreError
    from fairyring.storage.predictions import latest_run
    from fairyring.storage.runs import require_run, require_two

    with project.read() as connection:
        run = require_run(connection, wanted.run) if wanted.run is not None else None
        other = require_run(connection, wanted.against) if wanted.against is not None else None
        latest = latest_run(connection)
    after = run or latest
    with steps_shown() as progress:
        if other is not None and after is not None:
            require_two(other, after)
            before, found = reviews_of_both(
                project, other, after, images=wanted.images, only_sure=wanted.sure, progress=progress
            )
            return found, before
        found = review_of(project, run=run, images=wanted.images, only_sure=wanted.sure, progress=progress)
    if found.of_some and not found.images and not found.untouched:
        raise StoreError(f"The project has no image called {wanted.images}.")
    return found, None


def _agreement(project: Project, second: str, images: str) -> tuple[str, Agreement]:
    """How far the annotations agree with what another annotator labelled, and what that is called."""
    from fairyring.app.review.two_annotators import agreement_with_labels, agreement_with_run
    from fairyring.model.coco.document import read_document
    from fairyring.storage.runs import require_run

    file = Path(second)
    if file.is_file():
        document = read_document(file)
        with named(file):
            return file.name, agreement_with_labels(project, document, images=images)
    with project.read() as connection:
        run = require_run(connection, second)
    return run.name, agreement_with_run(project, run, images=images)


def _write_report(
    project: Project,
    found: Review,
    out: Path,
    before: Review | None,
    second: tuple[str, Agreement] | None,
) -> None:
    from fairyring.app.report.page import page_of

    write_bytes(page_of(project, found, before=before, second=second).encode(), out)
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
