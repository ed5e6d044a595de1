"""``fairyring rules``: how people work in a project."""

from __future__ import annotations

import json
from typing import Annotated

import typer
from msgspec import structs, to_builtins

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
    as_json: AsJson = False,
) -> None:
    """Say how people work in a project, or set it.

    Unless the project says otherwise, whoever labelled an image or a cap cannot approve it.

    Example: `fairyring rules beds --approve-own`
    """
    from fairyring.storage.project import open_project
    from fairyring.storage.rules import rules_of, set_rules

    with open_project(folder) as project:
        with project.read() as connection:
            found = rules_of(connection)
        if approve_own is not None:
            found = structs.replace(found, approve_own=approve_own)
            project.write(lambda connection: set_rules(connection, found))
    if as_json:
        typer.echo(json.dumps({"approve_own": found.approve_own} | to_builtins(found)))
        return
    typer.echo(f"Approving one's own work: {'allowed' if found.approve_own else 'not allowed'}")
