"""``fairyring runs``: the runs of a project, and what each of them said."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fairyring.app.commands.names import checked_name
from fairyring.app.commands.progress import steps_shown
from fairyring.app.commands.project import ProjectFolder
from fairyring.app.commands.rows import AsJson, print_rows
from fairyring.app.how_many import how_many

if TYPE_CHECKING:
    from fairyring.storage.runs import RunRow

commands = typer.Typer(
    no_args_is_help=True, rich_markup_mode=None, help="List, show, rename and compare runs of predictions."
)

NamedRun = Annotated[str, typer.Argument(metavar="RUN", help="Name or number of a run.")]


@commands.command("list")
def list_(folder: ProjectFolder, *, as_json: AsJson = False) -> None:
    """List the runs of a project, and of how many images each is the latest.

    Example: `fairyring runs list beds`
    """
    from fairyring.storage.project import open_project
    from fairyring.storage.runs import list_runs

    with open_project(folder) as project, project.read() as connection:
        rows = [_row(each) for each in list_runs(connection)]
    if not rows and not as_json:
        typer.echo("There are no runs; fairyring predict makes one.", err=True)
        return
    print_rows(f"runs of {folder}", rows, as_json=as_json)


@commands.command()
def show(folder: ProjectFolder, run: NamedRun, *, as_json: AsJson = False) -> None:
    """Show what made a run, with which settings, and which images it saw.

    Example: `fairyring runs show beds "lite0 1a2b3c4d"`
    """
    from msgspec import to_builtins

    from fairyring.storage.project import open_project
    from fairyring.storage.runs import images_seen_by, list_runs, require_run

    with open_project(folder) as project, project.read() as connection:
        found = require_run(connection, run)
        row = next(_row(each) for each in list_runs(connection) if each.run.id == found.id)
        names = [image.file_name for image in images_seen_by(connection, found.id)]
    figures = row | {"weights": found.weights, "settings": to_builtins(found.settings), "files": names}
    if as_json:
        typer.echo(json.dumps(figures))
        return
    for key, value in figures.items():
        shown = value if isinstance(value, str | int) else json.dumps(value)
        typer.echo(f"{key.replace('_', ' ')}: {shown}")


@commands.command()
def rename(
    folder: ProjectFolder,
    run: NamedRun,
    name: Annotated[
        str,
        typer.Argument(metavar="NAME", help="What it is to be called.", callback=checked_name("run")),
    ],
) -> None:
    """Give a run another name.

    Example: `fairyring runs rename beds 3 "before the new lamps"`
    """
    from fairyring.storage.project import open_project
    from fairyring.storage.runs import rename_run, require_run

    with open_project(folder) as project:
        with project.read() as connection:
            found = require_run(connection, run)
        project.write(lambda connection: rename_run(connection, found.id, name))
    typer.echo(f"{found.name} is called {name} now.", err=True)


@commands.command()
def compare(
    folder: ProjectFolder,
    run: NamedRun,
    other: Annotated[str, typer.Argument(metavar="OTHER", help="Name or number of another run.")],
    *,
    iou: Annotated[float, typer.Option(min=0.01, max=1, help="Least IoU of a pair.")] = 0.5,
    score: Annotated[
        float, typer.Option(min=0, max=1, help="Predictions of a lower score are left out.")
    ] = 0.0,
    as_json: AsJson = False,
) -> None:
    """Compare the centres of two runs, cap by cap, with what people marked on the images that both saw.

    Example: `fairyring runs compare beds 1 2 --json`
    """
    import msgspec

    from fairyring.app.caps.runs_compared import compare_runs
    from fairyring.app.commands.evaluate import of_two, print_centres, print_difference
    from fairyring.model.evaluate.centre_figures import CapPairing
    from fairyring.model.evaluate.two_runs import difference_of
    from fairyring.storage.project import open_project
    from fairyring.storage.runs import require_run, require_two

    pairing = CapPairing(least_iou=iou, least_score=score)
    with open_project(folder) as project, steps_shown() as progress:
        with project.read() as connection:
            first, second = require_run(connection, run), require_run(connection, other)
        require_two(first, second)
        compared = compare_runs(project, first, second, pairing, progress=progress)
    difference = difference_of(compared.first, compared.second)
    figures = compared.first.figures, compared.second.figures
    if as_json:
        typer.echo(msgspec.json.encode(of_two(figures, difference)))
        return
    for each, said in zip((first, second), figures, strict=True):
        print_centres(f"{each.name}, {how_many(compared.images, 'image')}", said)
    print_difference(difference)


def _row(row: RunRow) -> dict[str, Any]:
    return {
        "number": row.run.id,
        "name": row.run.name,
        "kind": row.run.kind,
        "made_at": row.run.made_at,
        "images": row.images,
        "predictions": row.predictions,
        "latest_of": row.latest_of,
    }
