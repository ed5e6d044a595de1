"""Commands on the images of a project: take-out, put-back, relink."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path, PurePosixPath
from shlex import quote
from typing import TYPE_CHECKING, Annotated
from unicodedata import normalize

import typer

from fairyring.app.commands.names import checked_name
from fairyring.app.commands.progress import steps_shown
from fairyring.app.commands.project import ProjectFolder
from fairyring.app.commands.rows import AsJson
from fairyring.model.errors import FairyringError

if TYPE_CHECKING:
    from fairyring.storage.project import Project
    from fairyring.storage.taken_out import TakenOut

Names = Annotated[list[str], typer.Argument(metavar="NAME...", help="File names, or patterns such as bed_*.")]
By = Annotated[str, typer.Option("--by", metavar="NAME", help="Who does it.", callback=checked_name("user"))]


def take_out(folder: ProjectFolder, names: Names, *, by: By = "command", as_json: AsJson = False) -> None:
    """Take images out of a project, with their labels and history; put-back undoes it.

    What was taken out is kept until the project has been served again and closed.

    Example: `fairyring take-out beds "blurred_*"`
    """
    from fairyring.storage.project import open_project
    from fairyring.storage.taken_out import take_out as take

    with open_project(folder) as project, steps_shown():
        taken = take(project, images_called(project, names), user=by)
    caps = sum(each.caps for each in taken)
    if as_json:
        typer.echo(json.dumps({"images": len(taken), "annotations": caps}))
        return
    typer.echo(f"{len(taken)} images with {caps} annotations were taken out of {folder}.")
    typer.echo(f"Undo it with: fairyring put-back {quote(str(folder))}", err=True)


def put_back(
    folder: ProjectFolder,
    names: Annotated[
        list[str] | None, typer.Argument(metavar="[NAME...]", help="Which, by name or number; else all.")
    ] = None,
    *,
    as_json: AsJson = False,
) -> None:
    """Put images back that were taken out, as they were.

    Example: `fairyring put-back beds blurred_7.jpg`
    """
    from fairyring.storage.project import open_project
    from fairyring.storage.taken_out import put_back as put
    from fairyring.storage.taken_out import taken_out

    with open_project(folder) as project, steps_shown():
        kept = taken_out(project)
        wanted = [
            each
            for each in kept
            if names is None or str(each.number) in names or _is_called(each.file_name, names)
        ]
        if not wanted:
            there = ", ".join(each.file_name for each in kept) or "nothing"
            raise FairyringError(f"Nothing is put back: {there} was taken out of {folder}.")
        _require_one_of_each_name(wanted)
        put(project, wanted)
    if as_json:
        typer.echo(json.dumps({"images": len(wanted), "annotations": sum(each.caps for each in wanted)}))
    else:
        typer.echo(f"Put back into {folder}: {', '.join(each.file_name for each in wanted)}")


def _require_one_of_each_name(wanted: Sequence[TakenOut]) -> None:
    for name, count in Counter(each.file_name for each in wanted).items():
        if count > 1:
            which = ", ".join(
                f"{each.number} ({each.caps} caps, taken out {each.made_at[:16]})"
                for each in wanted
                if each.file_name == name
            )
            raise FairyringError(f"{name} was taken out {count} times; give the number of one: {which}.")


def relink(
    folder: ProjectFolder,
    places: Annotated[list[Path], typer.Argument(metavar="FOLDER...", help="Where the photos may lie now.")],
    *,
    as_json: AsJson = False,
) -> None:
    """Find photos that are gone from their place, by their bytes: linked ones are linked anew, others copied.

    Example: `fairyring relink beds /mnt/photos`
    """
    from fairyring.storage.project import open_project
    from fairyring.storage.relinking import relink as look

    with open_project(folder) as project, steps_shown() as progress:
        relinked = look(project, places, progress=progress)
    for name in relinked.missing:
        typer.echo(f"{name} is in none of these folders.", err=True)
    if as_json:
        typer.echo(json.dumps({"found": len(relinked.found), "missing": relinked.missing}))
    else:
        typer.echo(f"Photos found: {len(relinked.found)}; still missing: {len(relinked.missing)}")
    if relinked.missing and not relinked.found:
        raise typer.Exit(1)


def images_called(project: Project, patterns: Sequence[str]) -> list[int]:
    """The numbers of the images of these names, each a pattern; raises FairyringError where one has none."""
    from fairyring.storage.images import ImageFilter, get_image, list_ids

    with project.read() as connection:
        images = [get_image(connection, number) for number in list_ids(connection, ImageFilter())]
    if not images:
        raise FairyringError(f"{project.folder} holds no images; take some in with fairyring import.")
    for pattern in patterns:
        if not any(_is_called(image.file_name, [pattern]) for image in images):
            raise FairyringError(f"No image of {project.folder} is called {pattern}; check the name.")
    return [image.id for image in images if _is_called(image.file_name, patterns)]


def _is_called(file_name: str, patterns: Sequence[str]) -> bool:
    """Whether a name, with or without its folders, is one of the patterns', however letters are composed."""
    names = (file_name, PurePosixPath(file_name).name)
    patterns = [normalize("NFC", pattern) for pattern in patterns]
    return any(fnmatchcase(name, pattern) or name == pattern for name in names for pattern in patterns)
