"""The command that makes the demo project."""

from __future__ import annotations

from pathlib import Path
from shlex import quote
from typing import Annotated

import typer

from fairyring.app.commands.progress import shown_on_stderr
from fairyring.app.commands.project import ProjectFolder
from fairyring.app.commands.serve import Port, open_for_people
from fairyring.app.commands.stopping import INTERRUPTED, stopped_by_sigterm


def demo(
    folder: ProjectFolder,
    *,
    count: Annotated[int, typer.Option(help="How many beds.", min=1)] = 12,
    seed: Annotated[int, typer.Option(help="The same seed gives the same beds.")] = 1,
    serve: Annotated[bool, typer.Option("--serve", help="Then open it in the browser.")] = False,
    port: Port = None,
) -> None:
    """Make a project of generated beds with predictions; an existing one is left as it is.

    After Ctrl+C or SIGTERM (exit code 130), or a crash, the same command goes on where it stopped.

    Example: `fairyring demo demo --serve`
    """
    from fairyring.app.demo.begun import begun_in
    from fairyring.storage.folder import is_project

    is_there = is_project(folder) and begun_in(folder) is None
    if not is_there:
        _make(folder, count=count, seed=seed)
    if serve:
        # Rendered beds are nobody's secret, and a newcomer's first address should be a short one.
        open_for_people(folder, port=port, token=False)
    elif is_there:
        typer.echo(f"{folder} is there already; delete the folder to start afresh.", err=True)
    else:
        typer.echo(f"Made {folder}. Next: fairyring serve {quote(str(folder))}", err=True)


def _make(folder: Path, *, count: int, seed: int) -> None:
    try:
        with shown_on_stderr() as shown, stopped_by_sigterm(shown) as progress:
            # Torch and all takes a while to load.
            from fairyring.app.demo.making import make_demo

            make_demo(folder, count=count, seed=seed, progress=progress)
    except KeyboardInterrupt:
        typer.echo(f"Stopped; the same command goes on with {folder}.", err=True)
        raise typer.Exit(INTERRUPTED) from None
