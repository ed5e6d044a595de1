"""The command ``fairyring predict``."""

from __future__ import annotations

import json
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fairyring.app.commands.files import require_other_file, write_json
from fairyring.app.commands.images import images_called
from fairyring.app.commands.names import checked_name
from fairyring.app.commands.network import Device, Fast, OnDevice, passes_of
from fairyring.app.commands.progress import shown_on_stderr, steps_shown
from fairyring.app.commands.rows import AsJson
from fairyring.app.commands.stopping import INTERRUPTED, stopped_by_sigterm
from fairyring.model.errors import FairyringError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fairyring.app.jobs.finders import Finder
    from fairyring.storage.project import Project


class FoundBy(StrEnum):
    """How caps are found: by a network, or by a method that needs no weights."""

    network = "network"
    hough = "hough"
    watershed = "watershed"
    corners = "corners"


def predict(
    sources: Annotated[
        list[Path],
        typer.Argument(
            metavar="PROJECT|PHOTOS...", help="A project's folder; with --out photos, or folders of them."
        ),
    ],
    *,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.json", help="Write what is seen in photos that belong to no project, as COCO."
        ),
    ] = None,
    weights: Annotated[
        Path | None, typer.Option(help="Else the newest in PROJECT/weights, else the shipped ones.")
    ] = None,
    method: Annotated[
        FoundBy,
        typer.Option(help="Without weights, far from as good: circles, watershed by distance, corners."),
    ] = FoundBy.network,
    images: Annotated[str, typer.Option(metavar="GLOB", help="Only images of these file names.")] = "*",
    device: OnDevice = Device.auto,
    least_score: Annotated[
        float, typer.Option(min=0.0, max=1.0, help="Caps less sure are left out; 0 for measuring AP.")
    ] = 0.3,
    diameter: Annotated[
        float | None,
        typer.Option(min=2, max=5000, help="How wide most caps are, px; else it is measured in each photo."),
    ] = None,
    fast: Fast = False,
    redo: Annotated[bool, typer.Option(help="Predict images anew that these weights have seen.")] = False,
    name: Annotated[
        str | None,
        typer.Option(
            "--name",
            help="What the run is called; else after its weights.",
            callback=checked_name("run"),
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Predict the caps of a project's photos, or of others, with their whole outlines and centres.

    Every image is stored as it comes: after Ctrl+C or SIGTERM (exit code 130), the same command goes on.
    Annotations are never touched. A photo that cannot be read is reported and passed over.

    Example: `fairyring predict beds --images "bed_top_*" --weights run/weights.safetensors`

    Example: `fairyring predict photos/ --out centres.json`
    """
    from fairyring.storage.project import open_project

    if out is not None:
        if name is not None:
            raise typer.BadParameter("--name is for the run of a project; --out writes a file.")
        _predict_photos(
            sources,
            out,
            method=method,
            weights=weights,
            device=device,
            least_score=least_score,
            diameter=diameter,
            fast=fast,
            as_json=as_json,
        )
        return
    if len(sources) > 1:
        raise typer.BadParameter("give one project; photos need --out FILE.json", param_hint="PROJECT")
    with open_project(sources[0]) as project:
        wanted = images_called(project, [images])
        # Loading torch takes a while, which a wrong name need not wait for.
        from fairyring.app.jobs.predicting import predict_images

        finder = _finder(
            method, weights, project, device=device, least_score=least_score, diameter=diameter, fast=fast
        )
        stored: list[int] = []
        try:
            with shown_on_stderr() as shown, stopped_by_sigterm(shown) as progress:
                outcome = predict_images(
                    project,
                    finder,
                    wanted,
                    redo=redo,
                    called=name,
                    progress=progress,
                    predicted=stored.append,
                )
        except KeyboardInterrupt:
            typer.echo(f"Stopped; predicted and kept: {len(stored)}. The same command goes on.", err=True)
            raise typer.Exit(INTERRUPTED) from None
    for problem in outcome.problems:
        typer.echo(problem, err=True)
    if as_json:
        figures = {"images": outcome.images, "caps": outcome.caps, "known": outcome.known}
        typer.echo(json.dumps(figures | {"problems": len(outcome.problems), "run": outcome.run}))
    else:
        typer.echo(f"{outcome.run}: {outcome}", err=True)


def _finder(
    method: FoundBy,
    weights: Path | None,
    project: Project | None,
    *,
    device: Device,
    least_score: float,
    diameter: float | None,
    fast: bool,
) -> Finder:
    """The network with the weights that were asked for, else of the project; or a method without weights."""
    from fairyring.app.jobs.finders import ByColour, network_of
    from fairyring.app.weights import require_weights
    from fairyring.model.predict.shipped import SHIPPED

    if method is not FoundBy.network:
        if weights is not None or fast:
            raise typer.BadParameter(f"--method {method} needs no --weights, and there is no --fast of it.")
        return ByColour(method=method.value, diameter=diameter)
    return network_of(
        weights or (require_weights(project) if project else SHIPPED),
        device=device,
        least_score=least_score,
        passes=passes_of(fast=fast),
        diameter=diameter,
    )


def _predict_photos(
    sources: Sequence[Path],
    out: Path,
    *,
    method: FoundBy,
    weights: Path | None,
    device: Device,
    least_score: float,
    diameter: float | None,
    fast: bool,
    as_json: bool,
) -> None:
    from fairyring.app.jobs.predicting_photos import photos_at, predict_photos

    photos = photos_at(sources)
    require_other_file(out, *photos)
    finder = _finder(
        method, weights, None, device=device, least_score=least_score, diameter=diameter, fast=fast
    )
    with steps_shown() as progress:
        document, problems = predict_photos(photos, finder, progress=progress)
    for problem in problems:
        typer.echo(problem, err=True)
    if not document["images"]:
        raise FairyringError(f"No photo could be read, and {out} was not written.")
    write_json(document, out)
    figures = {"images": len(document["images"]), "caps": len(document["annotations"])}
    if as_json:
        typer.echo(json.dumps(figures | {"problems": len(problems)}))
    else:
        typer.echo(f"{out}: {figures['caps']} caps in {figures['images']} photos", err=True)
