"""The command split."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fairyring.app.commands.images import images_called
from fairyring.app.commands.project import ProjectFolder
from fairyring.app.commands.rows import AsJson
from fairyring.model.errors import FileError
from fairyring.model.splits import Split, SplitOrNone

if TYPE_CHECKING:
    from fairyring.storage.project import Project


def split(
    folder: ProjectFolder,
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="[NAME...]", help="File names, or patterns such as bed_*; else all images."),
    ] = None,
    *,
    to: Annotated[SplitOrNone | None, typer.Option("--to", help="Put the images into this split.")] = None,
    random: Annotated[
        tuple[float, float, float] | None,
        typer.Option(metavar="TRAIN VAL TEST", help="Divide the images at random, in this ratio."),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="The same seed divides in the same way.")] = 0,
    unsplit: Annotated[bool, typer.Option("--unsplit", help="Only images that are in no split yet.")] = False,
    listed: Annotated[
        Path | None, typer.Option("--list", metavar="FILE", help="Names as well from a file, one a line.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Say which images are for training, validation and test, or show it.

    Copies of a photo go along: they are never in two splits. Training obeys.

    Example: `fairyring split beds "monday_*" --to test`

    Example: `fairyring split beds --random 70 15 15 --seed 1 --unsplit`
    """
    from fairyring.storage.project import open_project

    if to is not None and random is not None:
        raise typer.BadParameter("give one of --to and --random")
    named = [*(names or ()), *(_names_in(listed) if listed else ())]
    if (named or unsplit) and to is None and random is None:
        raise typer.BadParameter("say --to a split, or --random with three shares")
    if to is not None and not (named or unsplit):
        raise typer.BadParameter('name the images; "*" for all', param_hint="NAME")
    if random is not None and (min(random) < 0 or not 0 < sum(random) < float("inf")):
        raise typer.BadParameter("shares are 0 or more, and one of them more than 0", param_hint="--random")
    with open_project(folder) as project:
        before: dict[int, str | None] = {}
        asked: list[int] = []
        if to is not None or random is not None:
            asked = _chosen(project, named, unsplit=unsplit)
            before = _store(project, asked, to=to, random=random, seed=seed)
        _print(project, before, asked, as_json=as_json)


def _names_in(listed: Path) -> list[str]:
    try:
        lines = listed.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not text"
        raise FileError(f"{listed} cannot be read: {reason}.") from error
    return [line.strip() for line in lines if line.strip()]


def _chosen(project: Project, names: Sequence[str], *, unsplit: bool) -> list[int]:
    from fairyring.storage.images import get_image

    called = images_called(project, names or ["*"])
    if not unsplit:
        return called
    with project.read() as connection:
        return [number for number in called if get_image(connection, number).split is None]


def _store(
    project: Project,
    images: Sequence[int],
    *,
    to: SplitOrNone | None,
    random: tuple[float, float, float] | None,
    seed: int,
) -> dict[int, str | None]:
    """Returns the images that are in another split now, each with the one before."""
    from fairyring.storage.splits import set_splits

    if random is None:
        said = None if to is SplitOrNone.none or to is None else to.value
        return project.write(lambda connection: set_splits(connection, dict.fromkeys(images, said)))
    from fairyring.app.jobs.splitting import divided_at_random

    shares = dict(zip(Split, random, strict=True))
    return project.write(
        lambda connection: set_splits(
            connection, divided_at_random(connection, set(images), shares, seed=seed)
        )
    )


def _print(project: Project, before: dict[int, str | None], asked: Sequence[int], *, as_json: bool) -> None:
    from fairyring.storage.about import images_by_split

    with project.read() as connection:
        counts = {name or "none": count for name, count in images_by_split(connection).items()}
    copies = len(before.keys() - set(asked))
    if as_json:
        typer.echo(json.dumps({"changed": len(before), "copies": copies, "splits": counts}))
        return
    if asked:
        along = f", {copies} of them copies of photos that were named" if copies else ""
        typer.echo(f"In another split now: {len(before)} images{along}.", err=True)
    typer.echo(", ".join(f"{name} {count}" for name, count in counts.items()) or "no images")
