"""``fairyring rules``: how people work in a project."""

from __future__ import annotations

import json
from typing import Annotated

import typer
from msgspec import structs

from fairyring.app.commands.project import ProjectFolder
from fairyring.app.commands.rows import AsJson


def rules(
    folder: ProjectFolder,
    *,
    approve_own: Annotated[
        bool | None,
        typer.Option(
            "--approve-own/--no-approve-own",
            help="Whether people may approve what they have labelled themselves.",
            show_default=False,
        ),
    ] = None,
    repeat_share: Annotated[
        float | None,
        typer.Option(
            min=0,
            max=1,
            metavar="SHARE",
            help="Share of the marked caps, 0 to 1, that people are asked to mark again.",
            show_default=False,
        ),
    ] = None,
    repeat_seed: Annotated[
        int | None,
        typer.Option(metavar="N", help="Which caps these are follows from it.", show_default=False),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Say how people work in a project, or set it.

    Unless the project says otherwise, whoever labelled an image or a cap cannot approve it. Caps that are
    marked again, without the first mark in sight, tell how far off people's marks are: the human floor.

    Example: `fairyring rules beds --approve-own --repeat-share 0.05`
    """
    from fairyring.storage.project import open_project
    from fairyring.storage.rules import rules_of, set_rules

    with open_project(folder) as project:
        with project.read() as connection:
            found = rules_of(connection)
        said = {"approve_own": approve_own, "repeat_share": repeat_share, "repeat_seed": repeat_seed}
        changes = {name: value for name, value in said.items() if value is not None}
        if changes:
            found = structs.replace(found, **changes)
            project.write(lambda connection: set_rules(connection, found))
    if as_json:
        typer.echo(json.dumps(structs.asdict(found)))
        return
    asked = f"{100 * found.repeat_share:g} % of the marked caps (seed {found.repeat_seed})"
    typer.echo(f"Marked again: {asked if found.repeat_share else 'none'}")
    typer.echo(f"Approving one's own work: {'allowed' if found.approve_own else 'not allowed'}")
