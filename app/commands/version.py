"""``fairyring --version``."""

from __future__ import annotations

import typer


def print_version(wanted: bool) -> None:
    """Prints the installed version and ends, where it was asked for."""
    if wanted:
        from importlib.metadata import version

        typer.echo(version("fairyring"))
        raise typer.Exit
