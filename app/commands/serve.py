"""The command that opens a project in the browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fairyring.app.commands.last_line import last_line
from fairyring.app.commands.project import ProjectFolder

Port = Annotated[int | None, typer.Option(help="Port to listen on: 8080.", min=1, max=65535)]


def serve(
    folder: ProjectFolder,
    *,
    host: Annotated[str | None, typer.Option(help="Address to listen on: 127.0.0.1.")] = None,
    port: Port = None,
    token: Annotated[
        bool | None,
        typer.Option("--token/--no-token", help="Let in only who opens the printed address, once: --token."),
    ] = None,
    config: Annotated[Path | None, typer.Option(help="TOML file; else the project's own.")] = None,
) -> None:
    """Open a project in the browser, until Ctrl+C.

    Example: `fairyring serve beds --port 8080`
    """
    open_for_people(folder, host=host, port=port, token=token, config=config)


def open_for_people(
    folder: Path,
    *,
    host: str | None = None,
    port: int | None = None,
    token: bool | None = None,
    config: Path | None = None,
) -> None:
    """Serves a project until Ctrl+C or SIGTERM; shows its address once it answers."""
    from fairyring.app.gateway.server import serve as run
    from fairyring.app.settings import load_settings

    settings = load_settings(folder, file=config, host=host, port=port, token=token)
    with last_line() as show:
        run(
            folder,
            settings=settings,
            ready=lambda address: show(f"{folder} is open at {address} (Ctrl+C ends it)"),
        )
