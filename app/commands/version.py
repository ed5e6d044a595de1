"""``fairyring --version``."""

from __future__ import annotations

import typer


def version() -> str:
    """The installed version."""
    from importlib.metadata import version as installed

    return installed("fairyring")


def print_version(wanted: bool) -> None:
    """Prints the installed version and ends, where it was asked for."""
    if wanted:
        typer.echo(version())
        raise typer.Exit
