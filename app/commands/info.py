"""The command info."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import typer
from msgspec import to_builtins

from fairyring.app.commands.project import ProjectFolder
from fairyring.app.commands.rows import AsJson

if TYPE_CHECKING:
    from fairyring.storage.about import Figures


def info(folder: ProjectFolder, *, as_json: AsJson = False) -> None:
    """Say what a project holds: images, caps, marks, runs, splits, people, disk.

    Example: `fairyring info beds`
    """
    import json

    from fairyring.storage.about import figures_of
    from fairyring.storage.project import open_project

    with open_project(folder) as project:
        figures = figures_of(project)
    if as_json:
        typer.echo(json.dumps(to_builtins(figures)))
        return
    for line in _lines(figures):
        typer.echo(line)


def _lines(figures: Figures) -> list[str]:
    status = ", ".join(f"{count} {name}" for name, count in figures.status.items())
    others = {"linked": figures.linked, "taken out": figures.taken_out}
    splits = {name or "none": count for name, count in figures.splits.items()}
    lines = [
        f"{figures.name}: {figures.images} images ({status}){_besides(others)}",
        f"caps: {figures.caps}, {figures.marks} of them with a mark"
        f"{_besides({'ignored': figures.ignored, 'doubtful': figures.doubtful})}",
        f"splits: {_listed(splits) or 'none'}",
        f"predictions: {figures.predictions}",
        *([f"whole outlines still to be found: {figures.lacking}"] if figures.lacking else []),
        *(
            f"  run {run.number}, {run.name}, {run.made_at[:16]}: {run.caps} caps in {run.images} images"
            for run in figures.runs
        ),
        f"people: {len(figures.people)}",
        *(f"  {person.name}: {person.edits} edits, the last {person.last[:16]}" for person in figures.people),
    ]
    disk = {name: f"{size / 1e6:.1f} MB" for name, size in figures.disk.items() if size}
    return [*lines, f"disk: {', '.join(f'{name} {size}' for name, size in disk.items())}"]


def _besides(counts: dict[str, int]) -> str:
    said = [f"{count} {name}" for name, count in counts.items() if count]
    return f"; {', '.join(said)}" if said else ""


def _listed(counts: dict[str, Any]) -> str:
    return ", ".join(f"{name} {count}" for name, count in counts.items())
