"""``fairyring bench network``: tables about weights as they are, each by one command."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fairyring.app.commands import bench_trained
from fairyring.app.commands.network import Device, Fast, OnDevice, passes_of
from fairyring.app.commands.network_tables import (
    Beds,
    Count,
    Real,
    Weights,
    detecting,
    folder_for_beds,
    labelled_sets,
)
from fairyring.app.commands.progress import shown_on_stderr
from fairyring.app.commands.rows import AsJson, print_rows

if TYPE_CHECKING:
    from fairyring.app.bench.network.sets import LabelledPhotos


commands = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Measure a network: each command prints a table of its own.",
)
commands.add_typer(bench_trained.commands)

Pictures = Annotated[
    Path | None, typer.Option(help="Folder for pictures of the best, a typical and the worst image.")
]


@commands.command()
def success(
    *,
    weights: Weights = None,
    beds: Beds = None,
    count: Count = None,
    real: Real = None,
    pictures: Pictures = None,
    device: OnDevice = Device.auto,
    fast: Fast = False,
    as_json: AsJson = False,
) -> None:
    """Masks found, by light, form and size (the paper's Figure 13), on the rendered test beds.

    Example: `fairyring bench network success --real photos --pictures examples`
    """
    from fairyring.app.bench.network import tables
    from fairyring.app.bench.network.pictures import draw_examples

    rows = []
    for photos, predicted in _predicted(weights, beds, count, real, device, fast=fast):
        rows += [{"set": photos.name} | row for row in tables.success_rows(predicted, photos)]
        if pictures is not None:
            draw_examples(predicted, photos, pictures)
    print_rows("success", rows, as_json=as_json)


@commands.command()
def centres(
    *,
    weights: Weights = None,
    beds: Beds = None,
    count: Count = None,
    real: Real = None,
    device: OnDevice = Device.auto,
    fast: Fast = False,
    as_json: AsJson = False,
) -> None:
    """From image to centre: CDR, pixels, missed and extra caps, on the rendered test beds.

    Example: `fairyring bench network centres --real photos --json`
    """
    from fairyring.app.bench.network import tables

    rows = [
        row
        for photos, predicted in _predicted(weights, beds, count, real, device, fast=fast)
        for row in tables.centre_rows(predicted, photos)
    ]
    print_rows("centres", rows, as_json=as_json)


@commands.command()
def clicks(
    *,
    weights: Weights = None,
    beds: Beds = None,
    count: Count = None,
    real: Real = None,
    device: OnDevice = Device.auto,
    as_json: AsJson = False,
) -> None:
    """The cap at one click in its middle, or in a box: IoU .5 and .75, of all and of missed caps, and time.

    Example: `fairyring bench network clicks --real photos --count 2`
    """
    from fairyring.app.bench.network.clicks import click_rows
    from fairyring.app.jobs.finders import network_of
    from fairyring.model.predict.shipped import SHIPPED

    predictor = network_of(weights or SHIPPED, device=device).predictor
    rows: list[dict[str, Any]] = []
    with folder_for_beds(beds) as folder, shown_on_stderr() as progress:
        for photos in labelled_sets(folder, count, real, progress):
            rows += click_rows(predictor, photos)
    print_rows("clicks", rows, as_json=as_json)


@commands.command()
def quality(
    *,
    weights: Weights = None,
    beds: Beds = None,
    count: Count = None,
    real: Real = None,
    device: OnDevice = Device.auto,
    fast: Fast = False,
    as_json: AsJson = False,
) -> None:
    """How well the network knows how good its outlines are: rank correlations with the true IoU.

    Example: `fairyring bench network quality --real photos --count 6`
    """
    from fairyring.app.bench.network.quality import quality_rows
    from fairyring.app.jobs.finders import network_of
    from fairyring.model.predict.shipped import SHIPPED

    passes = passes_of(fast=fast)
    predictor = network_of(weights or SHIPPED, device=device, least_score=0, passes=passes).predictor
    rows: list[dict[str, Any]] = []
    with folder_for_beds(beds) as folder, shown_on_stderr() as progress:
        for photos in labelled_sets(folder, count, real, progress):
            rows += quality_rows(predictor, photos, progress=progress)
    print_rows("quality", rows, as_json=as_json)


@commands.command()
def wholes(
    *,
    weights: Weights = None,
    beds: Beds = None,
    count: Count = None,
    real: Real = None,
    device: OnDevice = Device.auto,
    as_json: AsJson = False,
) -> None:
    """Centres of hidden caps by the rim, by the network's ellipses, and by both, by share in sight.

    Example: `fairyring bench network wholes --real photos --count 6`
    """
    from fairyring.app.bench.network.wholes import whole_rows
    from fairyring.app.jobs.finders import network_of
    from fairyring.model.predict.shipped import SHIPPED

    predictor = network_of(weights or SHIPPED, device=device).predictor
    rows: list[dict[str, Any]] = []
    with folder_for_beds(beds) as folder, shown_on_stderr() as progress:
        for photos in labelled_sets(folder, count, real, progress):
            rows += whole_rows(predictor, photos, progress=progress)
    print_rows("wholes", rows, as_json=as_json)


@commands.command()
def peers(
    *,
    weights: Weights = None,
    beds: Beds = None,
    count: Count = None,
    real: Real = None,
    diameter: Annotated[
        float | None, typer.Option(min=2, help="How wide most caps are, px, told to the others.")
    ] = None,
    device: OnDevice = Device.auto,
    as_json: AsJson = False,
) -> None:
    """The network beside methods without weights: Hough, watershed by distance, corners (Table 1).

    Example: `fairyring bench network peers --real photos --count 6`
    """
    from fairyring.app.bench.network.peers import peer_rows
    from fairyring.app.jobs.finders import network_of
    from fairyring.model.predict.shipped import SHIPPED

    predictor = network_of(weights or SHIPPED, device=device, least_score=0).predictor
    rows: list[dict[str, Any]] = []
    with folder_for_beds(beds) as folder, shown_on_stderr() as progress:
        for photos in labelled_sets(folder, count, real, progress):
            rows += peer_rows(predictor, photos, diameter=diameter, progress=progress)
    print_rows("peers", rows, as_json=as_json)


@commands.command()
def cost(
    *,
    weights: Weights = None,
    beds: Beds = None,
    device: OnDevice = Device.auto,
    fast: Fast = False,
    as_json: AsJson = False,
) -> None:
    """Time of each stage from a decoded 1280 × 720 photo to stored centres, and memory.

    Example: `fairyring bench network cost --device cpu`
    """
    from fairyring.app.bench.network.cost import cost_rows
    from fairyring.app.bench.network.sets import rendered
    from fairyring.app.jobs.finders import network_of
    from fairyring.model.predict.shipped import SHIPPED

    predictor = network_of(weights or SHIPPED, device=device, passes=passes_of(fast=fast)).predictor
    with folder_for_beds(beds) as folder, shown_on_stderr() as progress:
        photos = rendered("paper", folder, count=1, progress=progress)
        rows = cost_rows(predictor, photos)
    print_rows("cost", rows, as_json=as_json)


@commands.command()
def ways(
    *, weights: Weights = None, beds: Beds = None, device: OnDevice = Device.auto, as_json: AsJson = False
) -> None:
    """Time of one forward pass as it is run, compiled, in bfloat16, channels first, at whole resolution.

    Example: `fairyring bench network ways --device cpu`
    """
    from fairyring.app.bench.network.sets import rendered
    from fairyring.app.bench.network.ways import way_rows
    from fairyring.model.device import device_of
    from fairyring.model.predict.shipped import SHIPPED

    with folder_for_beds(beds) as folder, shown_on_stderr() as progress:
        _, photo = next(rendered("paper", folder, count=1, progress=progress).images())
        rows = way_rows(weights or SHIPPED, photo, device=device_of(device))
    print_rows("ways", rows, as_json=as_json)


def _predicted(
    weights: Path | None, beds: Path | None, count: int | None, real: Path | None, device: str, *, fast: bool
) -> Iterator[tuple[LabelledPhotos, dict[str, Any]]]:
    """Each set of photos with the network's predictions for it."""
    from fairyring.app.bench.network.tables import predicted_document

    detect = detecting(weights, device, fast=fast)
    with folder_for_beds(beds) as folder, shown_on_stderr() as progress:
        for photos in labelled_sets(folder, count, real, progress):
            yield photos, predicted_document(detect, photos, progress=progress)
