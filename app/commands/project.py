"""Commands on a project folder: init, export, backup, restore."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fairyring.app.commands.progress import shown_on_stderr
from fairyring.app.commands.rows import AsJson
from fairyring.storage.choices import ExportFormat, Only
from fairyring.storage.folder import IMAGES, WEIGHTS

if TYPE_CHECKING:
    from fairyring.storage.backup import Backup

ProjectFolder = Annotated[Path, typer.Argument(metavar="PROJECT", help="The project's folder.")]


def init(
    folder: ProjectFolder,
    *,
    db: Annotated[str | None, typer.Option(help="SQLAlchemy URL; else project.db in the folder.")] = None,
) -> None:
    """Make an empty project.

    Example: `fairyring init beds`
    """
    from fairyring.storage.project import create_project

    create_project(folder, url=db).close()
    typer.echo(f"Made {folder}. Next: fairyring import {folder} PHOTOS", err=True)


def export(
    folder: ProjectFolder,
    out: Annotated[Path, typer.Argument(metavar="OUT", help="A new or empty folder.")],
    *,
    format_: Annotated[ExportFormat, typer.Option("--format", help="Format to write.")] = ExportFormat.coco,
    only: Annotated[Only, typer.Option(help="Which images.")] = Only.annotated,
    with_ignored: Annotated[bool, typer.Option(help="Keep ignored caps, as iscrowd 1.")] = False,
    as_json: AsJson = False,
) -> None:
    """Write a data set others can load, without images whose photo is no longer the one imported.

    Example: `fairyring export beds beds-coco --format coco --only approved`
    """
    from fairyring.app.caps.filling_in import fill_in
    from fairyring.storage.exporting import export_coco
    from fairyring.storage.project import open_project

    assert format_ is ExportFormat.coco
    with open_project(folder) as project, shown_on_stderr() as progress:
        fill_in(project, progress=progress)
        report = export_coco(project, out, only=only, with_ignored=with_ignored, progress=progress)
    for sentence in report.left_out:
        typer.echo(sentence, err=True)
    if report.partial and only is not Only.predicted:
        typer.echo(
            f'Of {report.partial} images nobody has said that all their caps are labelled: "partial": true '
            "marks them, which other programs do not know. --only approved leaves them out.",
            err=True,
        )
    left_out = len(report.left_out)
    if as_json:
        figures = {
            "images": report.images,
            "annotations": report.annotations,
            "partial": report.partial,
            "left_out": left_out,
        }
        typer.echo(json.dumps(figures))
    else:
        others = f"; {left_out} images left out" if left_out else ""
        typer.echo(f"{report.images} images, {report.annotations} annotations in {out}{others}")


def backup(
    folder: ProjectFolder,
    out: Annotated[Path, typer.Argument(metavar="OUT", help="A new folder.")],
    *,
    as_json: AsJson = False,
) -> None:
    """Copy labels, photos, settings and weights while people go on working; linked photos are not copied.

    Example: `fairyring backup beds beds-monday`
    """
    from fairyring.storage.backup import back_up
    from fairyring.storage.project import open_project

    with open_project(folder) as project, shown_on_stderr() as progress:
        made = back_up(project, out, progress=progress)
    for remark in made.remarks:
        typer.echo(remark, err=True)
    _print_backup(made, f"{out} holds", as_json=as_json)


def restore(
    backup: Annotated[Path, typer.Argument(metavar="BACKUP", help="A folder that fairyring backup made.")],
    folder: Annotated[Path, typer.Argument(metavar="PROJECT", help="A new folder.")],
    *,
    as_json: AsJson = False,
) -> None:
    """Make a project of a backup, which is checked first.

    Example: `fairyring restore beds-monday beds`
    """
    from fairyring.storage.backup import restore as restore_

    with shown_on_stderr() as progress:
        made = restore_(backup, folder, progress=progress)
    _print_backup(made, f"{folder} holds", as_json=as_json)


def _print_backup(backup: Backup, holds: str, *, as_json: bool) -> None:
    figures = {
        "images": backup.images,
        "photos": backup.files_in(IMAGES),
        "linked": len(backup.linked),
        "annotations": backup.rows["annotation"],
        "predictions": backup.rows["prediction"],
        "weights": backup.files_in(WEIGHTS),
        "remarks": len(backup.remarks),
    }
    if as_json:
        typer.echo(json.dumps(figures))
        return
    linked = f" ({len(backup.linked)} are linked and stay where they are)" if backup.linked else ""
    typer.echo(
        f"{holds} {figures['images']} images, {figures['photos']} photos of them{linked}, "
        f"{figures['annotations']} annotations, {figures['predictions']} predictions, the settings, "
        f"and {figures['weights']} files of weights."
    )
