"""Figures in rows, as a table for people or as JSON."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from rich.console import Console

UNBOUNDED = 10_000
"""Columns; wider than any table."""

AsJson = Annotated[bool, typer.Option("--json", help="Print the figures as JSON.")]


def print_rows(title: str, rows: list[dict[str, Any]], *, as_json: bool) -> None:
    """Prints a table with a column for each key of the first row, or the rows as JSON."""
    if as_json:
        typer.echo(json.dumps(rows))
        return
    from rich.table import Table

    table = Table(title=title)
    for column in rows[0]:
        table.add_column(column.replace("_", " "))
    for row in rows:
        table.add_row(*("" if value is None else str(value) for value in row.values()))
    console_of_tables().print(table)


def console_of_tables() -> Console:
    """Standard output. In a file or a pipe a table is as wide as its figures need."""
    from rich.console import Console

    console = Console()
    return console if console.is_terminal else Console(width=UNBOUNDED)
