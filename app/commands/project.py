"""Commands on a project folder: init, export, backup, restore."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated, BinaryIO

import typer

from fairyring.app.commands.progress import steps_shown
from fairyring.app.commands.rows import AsJson
from fairyring.model.errors import FileError
from fairyring.model.whole_files import written_whole
from fairyring.storage.choices import ExportedPhotos, ExportFormat, Only
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
    typer.echo(f"Made {folder}. Next: fairyring import {quote(str(folder))} PHOTOS", err=True)


def export(
    folder: ProjectFolder,
    out: Annotated[Path, typer.Argument(metavar="OUT", help="A new or empty folder.")],
    *,
    format_: Annotated[ExportFormat, typer.Option("--format", help="Format to write.")] = ExportFormat.coco,
    only: Annotated[
        Only | None, typer.Option(help="Which images; else annotated.", show_default=False)
    ] = None,
    run: Annotated[
        str | None, typer.Option(metavar="NAME", help="Predictions of this run (fairyring runs list).")
    ] = None,
    with_ignored: Annotated[bool, typer.Option(help="Keep ignored caps, as iscrowd 1.")] = False,
    results: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.json", help="Write predictions as a list of COCO results (RLE, scores) as well."
        ),
    ] = None,
    license_: Annotated[
        str | None, typer.Option("--license", metavar="NAME", help="Licence of the data; else the photos'.")
    ] = None,
    skip_missing: Annotated[
        bool, typer.Option("--skip-missing", help="Leave out images whose photo is gone, and list them.")
    ] = False,
    labels_only: Annotated[bool, typer.Option("--labels-only", help="Write no photos.")] = False,
    link: Annotated[bool, typer.Option("--link", help="Link photos in place of copying them.")] = False,
    by_split: Annotated[
        bool,
        typer.Option("--by-split", help="A data set each in train/, val/ and test/; no split: train/."),
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Write a data set others can load, without images whose photo is no longer the one imported.

    Example: `fairyring export beds beds-coco --format coco --only approved`
    """
    from fairyring.app.caps.filling_in import fill_in
    from fairyring.model.processes import usable_cores
    from fairyring.storage.exporting import Wanted, export_coco
    from fairyring.storage.exporting_splits import export_splits
    from fairyring.storage.project import open_project
    from fairyring.storage.runs import require_run

    assert format_ is ExportFormat.coco
    if run is not None and only not in (None, Only.predicted):
        raise typer.BadParameter(f"--run writes predictions; --only {only} does not.")
    if labels_only and link:
        raise typer.BadParameter("give one of --labels-only and --link at most")
    photos = ExportedPhotos.linked if link else ExportedPhotos.copied
    which = only or (Only.annotated if run is None else Only.predicted)
    if results is not None and which is not Only.predicted:
        raise typer.BadParameter("--results are predictions; give --only predicted or --run.")
    if results is not None and by_split:
        raise typer.BadParameter("--results is one list; leave out --by-split.")
    with open_project(folder) as project, steps_shown() as progress:
        fill_in(project, progress=progress)
        with project.read() as connection:
            wanted = Wanted(
                only=which,
                run=None if run is None else require_run(connection, run),
                with_ignored=with_ignored,
                license=license_,
                photos=ExportedPhotos.none if labels_only else photos,
                skip_missing=skip_missing,
            )
        if by_split:
            report = export_splits(project, out, wanted, jobs=usable_cores(), progress=progress)
        else:
            with _written(results) as file:
                report = export_coco(
                    project, out, wanted, results=file, jobs=usable_cores(), progress=progress
                )
    for sentence in report.left_out:
        typer.echo(sentence, err=True)
    if report.runs:
        said = ", ".join(f"{name} ({_counted(seen, 'image')})" for name, seen in report.runs.items())
        typer.echo(f"Predictions of {said}.", err=True)
    if report.partial and which is not Only.predicted:
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
            "runs": report.runs,
        } | ({"splits": report.splits} if by_split else {})
        typer.echo(json.dumps(figures))
    else:
        others = f"; {left_out} images left out" if left_out else ""
        others += "".join(f"; {count} in {split}/" for split, count in report.splits.items())
        typer.echo(f"{report.images} images, {report.annotations} annotations in {out}{others}")


@contextmanager
def _written(path: Path | None) -> Iterator[BinaryIO | None]:
    """A file to write, whole or not at all; None where none is asked for. Raises FileError."""
    if path is None:
        yield None
        return
    try:
        with written_whole(path) as fresh, fresh.open("wb") as file:
            yield file
    except OSError as error:
        raise FileError(f"{path} cannot be written: {error.strerror or error}.") from error


def _counted(count: int, what: str) -> str:
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


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

    with open_project(folder) as project, steps_shown() as progress:
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

    with steps_shown() as progress:
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
