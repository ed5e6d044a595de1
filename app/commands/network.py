"""The commands around the network: train and predict."""

from __future__ import annotations

import json
from enum import StrEnum
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.commands.progress import shown_on_stderr
from app.commands.project import AsJson, ProjectFolder
from model.errors import FairyringError

if TYPE_CHECKING:
    from storage.project import Project

INTERRUPTED = 130
"""Exit code after Ctrl+C, as shells have it."""


class Device(StrEnum):
    """What to compute on."""

    auto = "auto"
    cpu = "cpu"
    cuda = "cuda"


OnDevice = Annotated[Device, typer.Option(help="auto takes a GPU where there is one.")]


def predict(
    folder: ProjectFolder,
    *,
    weights: Annotated[
        Path | None, typer.Option(help="Else the newest in PROJECT/weights, else the shipped ones.")
    ] = None,
    images: Annotated[str, typer.Option(metavar="GLOB", help="Only images of these file names.")] = "*",
    device: OnDevice = Device.auto,
    least_score: Annotated[
        float, typer.Option(min=0.05, max=1.0, help="Caps less sure are left out; 0.05 for measuring AP.")
    ] = 0.3,
    redo: Annotated[bool, typer.Option(help="Predict images anew that these weights have seen.")] = False,
    as_json: AsJson = False,
) -> None:
    """Predict the caps of a project's photos, with their whole outlines and centres.

    Every image is stored as it comes: after Ctrl+C (exit code 130), the same command goes on. Annotations are
    never touched. A photo that cannot be read is reported and passed over.

    Example: `fairyring predict beds --images "bed_top_*" --weights run/weights.safetensors`
    """
    from storage.project import open_project

    with open_project(folder) as project:
        wanted = _images_called(project, images)
        # Loading torch takes a while, which a wrong name need not wait for.
        from app.predicting import network_of, predict_images
        from app.weights import require_weights

        network = network_of(weights or require_weights(project), device=device, least_score=least_score)
        stored: list[int] = []
        try:
            with shown_on_stderr() as progress:
                outcome = predict_images(
                    project, network, wanted, redo=redo, progress=progress, predicted=stored.append
                )
        except KeyboardInterrupt:
            typer.echo(f"Stopped; predicted and kept: {len(stored)}. The same command goes on.", err=True)
            raise typer.Exit(INTERRUPTED) from None
    for problem in outcome.problems:
        typer.echo(problem, err=True)
    if as_json:
        figures = {"images": outcome.images, "caps": outcome.caps, "known": outcome.known}
        typer.echo(json.dumps(figures | {"problems": len(outcome.problems)}))
    else:
        typer.echo(f"{network.name}: {outcome}", err=True)


def _images_called(project: Project, pattern: str) -> list[int]:
    from storage.images import ImageFilter, get_image, list_ids

    with project.read() as connection:
        images = [get_image(connection, number) for number in list_ids(connection, ImageFilter())]
    found = [image.id for image in images if fnmatchcase(image.file_name, pattern)]
    if not images:
        raise FairyringError(f"{project.folder} holds no images; take some in with fairyring import.")
    if not found:
        raise FairyringError(f"No image of {project.folder} is called {pattern}; check --images.")
    return found
