"""What the command import says of an import."""

from __future__ import annotations

import json
from collections import defaultdict
from typing import TYPE_CHECKING

import typer

from fairyring.storage.choices import ImportAs, KnownCaps, Polygons

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fairyring.storage.formats.found import Problem
    from fairyring.storage.importing.storing import ImportReport

MOST_ALIKE = 3
"""Files with one and the same problem that are named; of more it is said how many there are."""
_TAKEN_FOR = {
    Polygons.visible: "were taken for what is visible of caps (--polygons marks: for marks as well).",
    Polygons.marks: "were taken for marks as well: centres are theirs (--polygons visible: worked out).",
}


def print_report(
    report: ImportReport, *, as_: ImportAs | None, polygons: Polygons, known_caps: KnownCaps, as_json: bool
) -> None:
    """Prints the problems and what was taken how on stderr, the figures on stdout."""
    for sentence in sentences_on(report.problems):
        typer.echo(sentence, err=True)
    if report.polygons and as_ in (None, ImportAs.annotations):
        typer.echo(f"{report.polygons} polygons of labelme {_TAKEN_FOR[polygons]}", err=True)
    if report.boxes:
        typer.echo(
            f"{report.boxes} boxes without an outline are rectangles now, and doubtful: correct their rims.",
            err=True,
        )
    if report.unscored:
        typer.echo(
            "No label carries a score, as those of a model do. If a person labelled them, import the same "
            "again with --as second: then CDR goes on to be measured against the model.",
            err=True,
        )
    if known_caps is KnownCaps.tell and report.images_otherwise:
        typer.echo(
            f"Left as they are: {report.images_otherwise} images of which the files say another light, form "
            "or split; --update takes it.",
            err=True,
        )
    if known_caps is KnownCaps.tell and (report.changed or report.gone):
        typer.echo(_untaken(report), err=True)
    if report.useless:
        others = f" and of {len(report.useless) - 1} more files" if len(report.useless) > 1 else ""
        typer.echo(f"No label of {report.useless[0]}{others} could be used.", err=True)
    _print_figures(report, as_=as_, as_json=as_json)


def sentences_on(problems: Sequence[Problem]) -> Iterator[str]:
    """A line a problem; of many files with one and the same the first few, and how many more there are."""
    alike: defaultdict[str, list[Problem]] = defaultdict(list)
    for problem in problems:
        if not problem.where:
            alike[problem.reason].append(problem)
    for problem in problems:
        others = alike[problem.reason] if not problem.where else [problem]
        if problem in others[:MOST_ALIKE]:
            yield str(problem)
        elif problem is others[MOST_ALIKE]:
            yield f"{len(others) - MOST_ALIKE} more files (--json lists them): {problem.reason}"


def _untaken(report: ImportReport) -> str:
    """What an import left as it was, and how to have it otherwise."""
    return (
        f"Left as they are: {report.changed} caps of which the files say something else, "
        f"{report.gone} which no file has. --update takes what is said as edits, --replace deletes the "
        "others too, --keep leaves all as they are without a word."
    )


def _print_figures(report: ImportReport, *, as_: ImportAs | None, as_json: bool) -> None:
    figures = {
        "images": report.images,
        "images_known": report.images_known,
        "annotations": report.annotations,
        "predictions": report.predictions,
        "boxes": report.boxes,
        "known": report.known,
        "changed": report.changed,
        "same": report.known - report.changed,
        "gone": report.gone,
        "images_otherwise": report.images_otherwise,
        "edits": report.edits,
        "problems": len(report.problems),
    }
    if as_json:
        listed = [
            {"file": problem.file, "where": problem.where, "reason": problem.reason}
            for problem in report.problems
        ]
        typer.echo(json.dumps(figures | {"listed": listed, "useless": report.useless}))
        return
    said = "caps of a second annotator" if as_ is ImportAs.second else "predictions"
    typer.echo(
        f"{report.images} new images, {report.annotations} annotations, {report.predictions} {said}; "
        f"already there: {report.images_known} images, {report.known} shapes"
        f"{_said_of_known(report)}; {len(report.problems)} problems"
    )


def _said_of_known(report: ImportReport) -> str:
    if not report.known and not report.gone:
        return ""
    edits = f"; edits: {report.edits}" if report.edits else ""
    return f" ({report.known - report.changed} the same, {report.changed} changed; {report.gone} gone{edits})"
