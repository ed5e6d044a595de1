"""The command import."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fairyring.app.commands.import_report import print_report
from fairyring.app.commands.names import checked_name
from fairyring.app.commands.progress import steps_shown
from fairyring.app.commands.project import ProjectFolder
from fairyring.app.commands.rows import AsJson
from fairyring.model.light_and_form import FORMS, LightSource
from fairyring.storage.choices import ImportAs, ImportFormat, KnownCaps, Polygons, Said

if TYPE_CHECKING:
    from fairyring.storage.importing.paths import UnsaidError
    from fairyring.storage.importing.storing import ImportReport


FEW = 1000
"""The whole outlines of so many caps are found before anybody notices."""
_LATER = (
    "Whole outlines and centres of {lacking} caps are found when they are first needed: by serve in the "
    "background, by export, by review."
)


def import_(
    folder: ProjectFolder,
    paths: Annotated[list[Path], typer.Argument(metavar="PATH...", help="Images, folders, JSON files.")],
    *,
    format_: Annotated[
        ImportFormat, typer.Option("--format", help="What the paths hold.")
    ] = ImportFormat.auto,
    as_: Annotated[
        ImportAs | None,
        typer.Option(
            "--as",
            help="What the shapes become: annotations, what a model said, or what a second annotator "
            "labelled. Asked where all carry a score.",
        ),
    ] = None,
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
    by: Annotated[
        str, typer.Option(metavar="NAME", help="Whom the journal names.", callback=checked_name("user"))
    ] = "import",
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
    doubled: what files say otherwise of them is told, unless an option says what to do with it. The exit code
    is 1 where a file of labels has none that could be used. What a second annotator labelled in the same
    photos (--as second) stands beside the annotations, to be compared with them.

    Example: `fairyring import beds photos/ labels.json --as predictions`
    """
    from fairyring.storage.derived import count_underived
    from fairyring.storage.importing.intake import Facts
    from fairyring.storage.importing.paths import UnsaidError, import_paths
    from fairyring.storage.project import open_project

    if form is not None and form not in FORMS:
        raise typer.BadParameter("a form is one of the letters a to h", param_hint="--form")
    known_caps = _known_caps(update=update, replace=replace, keep=keep)

    def take(as_: ImportAs | None) -> tuple[ImportReport, int]:
        with open_project(folder) as project:
            with steps_shown() as progress:
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
            with project.read() as connection:
                return report, count_underived(connection)

    try:
        report, lacking = take(as_)
    except UnsaidError as error:
        as_ = _asked(error)
        report, lacking = take(as_)
    print_report(report, as_=as_, polygons=polygons, known_caps=known_caps, as_json=as_json)
    if lacking > FEW:
        typer.echo(_LATER.format(lacking=lacking), err=True)
    if report.useless:
        raise typer.Exit(1)


def _asked(error: UnsaidError) -> ImportAs:
    """What a person at a terminal says; raises the error where nobody can be asked."""
    if not (sys.stdin.isatty() and sys.stderr.isatty()):
        raise error
    typer.echo(str(error), err=True)
    said = typer.confirm("Are they predictions?", err=True)
    return ImportAs.predictions if said else ImportAs.annotations


def _known_caps(*, update: bool, replace: bool, keep: bool) -> KnownCaps:
    if update + replace + keep > 1:
        raise typer.BadParameter("give one of --update, --replace and --keep at most")
    if update or replace:
        return KnownCaps.replace if replace else KnownCaps.update
    return KnownCaps.keep if keep else KnownCaps.tell
