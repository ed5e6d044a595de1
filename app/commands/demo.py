"""The command that makes the demo project."""

from __future__ import annotations

from typing import Annotated

import typer

from fairyring.app.commands.progress import shown_on_stderr
from fairyring.app.commands.project import ProjectFolder


def demo(
    folder: ProjectFolder,
    *,
    count: Annotated[int, typer.Option(help="How many beds.", min=1)] = 12,
    seed: Annotated[int, typer.Option(help="The same seed gives the same beds.")] = 1,
) -> None:
    """Make a project of generated beds with predictions; an existing one is left as it is.

    Example: `fairyring demo demo && fairyring serve demo`
    """
    from fairyring.app.demo import make_demo

    if (folder / "fairyring.toml").exists():
        typer.echo(f"{folder} is there already; delete the folder to start afresh.", err=True)
        return
    with shown_on_stderr() as progress:
        make_demo(folder, count=count, seed=seed, progress=progress)
    typer.echo(f"Made {folder}. Next: fairyring serve {folder}", err=True)
