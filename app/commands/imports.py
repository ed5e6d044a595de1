"""The command import, and what it says of an import."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fairyring.app.commands.progress import shown_on_stderr
from fairyring.app.commands.project import ProjectFolder
from fairyring.app.commands.rows import AsJson
from fairyring.model.light_and_form import FORMS, LightSource
from fairyring.storage.choices import ImportAs, ImportFormat, KnownCaps, Polygons, Said

if TYPE_CHECKING:
    from fairyring.storage.importing.storing import ImportReport


def import_(
    folder: ProjectFolder,
    paths: Annotated[list[Path], typer.Argument(metavar="PATH...", help="Images, folders, JSON files.")],
    *,
    format_: Annotated[
        ImportFormat, typer.Option("--format", help="What the paths hold.")
    ] = ImportFormat.auto,
    as_: Annotated[ImportAs, typer.Option("--as", help="What the shapes become.")] = ImportAs.annotations,
    polygons: Annotated[
        Polygons,
        typer.Option(help="What labelme's polygons are: what is visible, or marks too, as in the paper."),
    ] = Polygons.visible,
    update: Annotated[
        bool, typer.Option("--update", help="Take what files say of known caps, as edits.")
    ] = False,
    replace: Annotated[
        bool, typer.Option("--replace", help="The same, and delete caps of these images that no file has.")
    ] = False,
    keep: Annotated[bool, typer.Option("--keep", help="Leave known caps as they are.")] = False,
    by: Annotated[str, typer.Option(metavar="NAME", help="Whom the journal names.")] = "import",
    strict: Annotated[bool, typer.Option(help="Take nothing if anything is wrong.")] = False,
    link: Annotated[bool, typer.Option(help="Leave the images where they are; do not copy.")] = False,
    light: Annotated[LightSource | None, typer.Option(help="Light source of these images.")] = None,
    form: Annotated[str | None, typer.Option(help="The paper's form of these images, a to h.")] = None,
    status: Annotated[
        Said | None,
        typer.Option(help="Say of labelled images that all their caps are; else their file says, or nobody."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Take in images and labels; report everything that is wrong, with file and reason.

    Caps that the project has already are recognised by their uid, their id or their outline, and never
    doubled: what files say otherwise of them is told, unless an option says what to do with it.

    Example: `fairyring import beds photos/ labels.json --as predictions`
    """
    from fairyring.app.caps.filling_in import fill_in
    from fairyring.storage.importing.intake import Facts
    from fairyring.storage.importing.paths import import_paths
    from fairyring.storage.project import open_project

    if form is not None and form not in FORMS:
        raise typer.BadParameter("a form is one of the letters a to h", param_hint="--form")
    known_caps = _known_caps(update=update, replace=replace, keep=keep)
    with open_project(folder) as project, shown_on_stderr() as progress:
        report = import_paths(
            project,
            paths,
            kind=format_,
            as_=as_,
            polygons=polygons,
            known_caps=known_caps,
            strict=strict,
            link=link,
            unsaid=Facts(light=light, form=form, status=None if status is None else status.value),
            progress=progress,
            user=by,
        )
        fill_in(project, progress=progress)
    for problem in report.problems:
        typer.echo(str(problem), err=True)
    if report.polygons and as_ is ImportAs.annotations:
        typer.echo(f"{report.polygons} polygons of labelme {_TAKEN_FOR[polygons]}", err=True)
    if known_caps is KnownCaps.tell and (report.changed or report.gone):
        typer.echo(_untaken(report), err=True)
    _print_import(report, as_json=as_json)


def _known_caps(*, update: bool, replace: bool, keep: bool) -> KnownCaps:
    if update + replace + keep > 1:
        raise typer.BadParameter("give one of --update, --replace and --keep at most")
    if update or replace:
        return KnownCaps.replace if replace else KnownCaps.update
    return KnownCaps.keep if keep else KnownCaps.tell


def _untaken(report: ImportReport) -> str:
    """What an import left as it was, and how to have it otherwise."""
    return (
        f"Left as they are: {report.changed} caps of which the files say something else, "
        f"{report.gone} which no file has. --update takes what is said as edits, --replace deletes the "
        "others too, --keep leaves all as they are without a word."
    )


_TAKEN_FOR = {
    Polygons.visible: "were taken for what is visible of caps (--polygons marks: for marks as well).",
    Polygons.marks: "were taken for marks as well: centres are theirs (--polygons visible: worked out).",
}


def _print_import(report: ImportReport, *, as_json: bool) -> None:
    figures = {
        "images": report.images,
        "images_known": report.images_known,
        "annotations": report.annotations,
        "predictions": report.predictions,
        "known": report.known,
        "changed": report.changed,
        "same": report.known - report.changed,
        "gone": report.gone,
        "edits": report.edits,
        "problems": len(report.problems),
    }
    if as_json:
        listed = [
            {"file": problem.file, "where": problem.where, "reason": problem.reason}
            for problem in report.problems
        ]
        typer.echo(json.dumps(figures | {"listed": listed}))
        return
    typer.echo(
        f"{report.images} new images, {report.annotations} annotations, {report.predictions} predictions; "
        f"already there: {report.images_known} images, {report.known} shapes"
        f"{_said_of_known(report)}; {len(report.problems)} problems"
    )


def _said_of_known(report: ImportReport) -> str:
    if not report.known and not report.gone:
        return ""
    edits = f"; edits: {report.edits}" if report.edits else ""
    return f" ({report.known - report.changed} the same, {report.changed} changed; {report.gone} gone{edits})"
