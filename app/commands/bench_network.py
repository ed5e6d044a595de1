"""``fairyring bench network``: the tables of docs/results.md, each by one command."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fairyring.app.commands.network import Device, Fast, OnDevice, passes_of
from fairyring.app.commands.progress import shown_on_stderr
from fairyring.app.commands.rows import AsJson, print_rows

if TYPE_CHECKING:
    from fairyring.app.bench.network.sets import LabelledPhotos
    from fairyring.model.photo import Pixels
    from fairyring.model.predict.seen import Detection
    from fairyring.model.progress import Progress

commands = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Measure a network: each command prints a table of its own.",
)

Weights = Annotated[Path | None, typer.Option(help="Else the shipped ones.")]
Beds = Annotated[Path | None, typer.Option(help="Folder where the rendered beds are kept, and looked for.")]
Count = Annotated[int | None, typer.Option(min=1, help="Fewer beds, to see that it works.")]
Real = Annotated[Path | None, typer.Option(help="Folder of photos with checked.json, measured too.")]
Pictures = Annotated[
    Path | None, typer.Option(help="Folder for pictures of the best, a typical and the worst image.")
]

Runs = Annotated[Path, typer.Option(help="Folder for the beds and the runs; runs there are gone on with.")]
Iterations = Annotated[int, typer.Option(min=1, help="Of every network.")]
TrainBeds = Annotated[int, typer.Option(min=1, help="Of each preset, to train on.")]
CropSide = Annotated[int, typer.Option(min=64, help="Side of the crops, photo pixels.")]


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
    from fairyring.app.bench.network.sets import TEST_BEDS, checked, rendered
    from fairyring.app.jobs.predicting import network_of
    from fairyring.model.predict.shipped import SHIPPED

    predictor = network_of(weights or SHIPPED, device=device).predictor
    rows: list[dict[str, Any]] = []
    with _folder(beds) as folder, shown_on_stderr() as progress:
        for name in TEST_BEDS:
            rows += click_rows(predictor, rendered(name, folder, count=count, progress=progress))
    if real is not None:
        rows += click_rows(predictor, checked(real))
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
    from fairyring.app.bench.network.sets import TEST_BEDS, checked, rendered
    from fairyring.app.jobs.predicting import network_of
    from fairyring.model.predict.shipped import SHIPPED

    passes = passes_of(fast=fast)
    predictor = network_of(weights or SHIPPED, device=device, least_score=0, passes=passes).predictor
    rows: list[dict[str, Any]] = []
    with _folder(beds) as folder, shown_on_stderr() as progress:
        sets = [rendered(name, folder, count=count, progress=progress) for name in TEST_BEDS]
        for photos in [*sets, *([] if real is None else [checked(real)])]:
            rows += quality_rows(predictor, photos, progress=progress)
    print_rows("quality", rows, as_json=as_json)


@commands.command()
def wholes(
    *,
    weights: Weights = None,
    beds: Beds = None,
    count: Count = None,
    real: Real = None,
    widened: Annotated[
        list[float] | None,
        typer.Option(min=0.01, help="Factor on the network's standard deviations (repeat for more)."),
    ] = None,
    device: OnDevice = Device.auto,
    as_json: AsJson = False,
) -> None:
    """Centres of hidden caps by the rim, by the network's ellipses, and by both, by share in sight.

    Example: `fairyring bench network wholes --real photos --count 6 --widened 1 --widened 2`
    """
    from fairyring.app.bench.network.sets import TEST_BEDS, checked, rendered
    from fairyring.app.bench.network.wholes import whole_rows
    from fairyring.app.jobs.predicting import network_of
    from fairyring.model.predict.shipped import SHIPPED

    predictor = network_of(weights or SHIPPED, device=device).predictor
    rows: list[dict[str, Any]] = []
    with _folder(beds) as folder, shown_on_stderr() as progress:
        sets = [rendered(name, folder, count=count, progress=progress) for name in TEST_BEDS]
        for photos in [*sets, *([] if real is None else [checked(real)])]:
            rows += whole_rows(predictor, photos, widened=widened or (1.0,), progress=progress)
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
    from fairyring.app.jobs.predicting import network_of
    from fairyring.model.predict.shipped import SHIPPED

    predictor = network_of(weights or SHIPPED, device=device, least_score=0).predictor
    rows: list[dict[str, Any]] = []
    with _folder(beds) as folder, shown_on_stderr() as progress:
        for photos in _sets(folder, count, real, progress):
            rows += peer_rows(predictor, photos, diameter=diameter, progress=progress)
    print_rows("peers", rows, as_json=as_json)


@commands.command()
def alike(
    *,
    out: Runs,
    iterations: Iterations = 600,
    train_beds: TrainBeds = 40,
    crop: CropSide = 256,
    count: Count = None,
    real: Real = None,
    device: OnDevice = Device.auto,
    as_json: AsJson = False,
) -> None:
    """PR-SOLOv2 beside SOLOv2, Mask R-CNN and YOLACT, all trained alike (Tables 2 and 3).

    Example: `fairyring bench network alike --out alike --count 6 --real photos`
    """
    from fairyring.app.bench.network.trained_alike import alike_rows
    from fairyring.model.device import device_of

    with shown_on_stderr() as progress:
        rows = alike_rows(
            folder=out,
            sets=_sets(out, count, real, progress),
            beds=train_beds,
            iterations=iterations,
            crop=crop,
            device=device_of(device),
            progress=progress,
        )
    print_rows("alike", rows, as_json=as_json)


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
    from fairyring.app.jobs.predicting import network_of
    from fairyring.model.predict.shipped import SHIPPED

    predictor = network_of(weights or SHIPPED, device=device, passes=passes_of(fast=fast)).predictor
    with _folder(beds) as folder, shown_on_stderr() as progress:
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

    with _folder(beds) as folder, shown_on_stderr() as progress:
        _, photo = next(rendered("paper", folder, count=1, progress=progress).images())
        rows = way_rows(weights or SHIPPED, photo, device=device_of(device))
    print_rows("ways", rows, as_json=as_json)


@commands.command("partial")
def partial_(
    *,
    weights: Weights = None,
    beds: Beds = None,
    count: Count = None,
    real: Annotated[
        Path | None, typer.Option(help="Folder of photos with checked.json, in place of rendered beds.")
    ] = None,
    labelled: Annotated[int, typer.Option(min=1, help="Caps that are labelled.")] = 3,
    iterations: Annotated[int, typer.Option(min=1, help="Of each training.")] = 30,
    device: OnDevice = Device.auto,
    fast: Fast = False,
    as_json: AsJson = False,
) -> None:
    """What learning from a photo with three caps labelled does to the others of its set; two photos in turn.

    Nothing that is learnt is kept.

    Example: `fairyring bench network partial --real photos`
    """
    from fairyring.app.bench.network.partly_labelled import Lesson, partly_labelled_rows
    from fairyring.app.bench.network.sets import TEST_BEDS, checked, rendered
    from fairyring.model.predict.shipped import SHIPPED

    lesson = Lesson(
        weights=weights or SHIPPED,
        detector_of=lambda weights: _detecting(weights, device, fast=fast),
        caps=labelled,
        iterations=iterations,
        device=device,
    )
    rows: list[dict[str, Any]] = []
    with _folder(beds) as kept, _folder(None) as folder, shown_on_stderr() as progress:
        sets = [checked(real)] if real else []
        for name in () if real else TEST_BEDS:
            sets.append(rendered(name, kept, count=count, progress=progress))
        for photos in sets:
            rows += partly_labelled_rows(lesson, photos, folder=folder, progress=progress)
    print_rows("partial", rows, as_json=as_json)


@commands.command()
def ablation(
    *,
    out: Runs,
    iterations: Iterations = 600,
    train_beds: TrainBeds = 60,
    crop: CropSide = 320,
    count: Count = None,
    device: OnDevice = Device.auto,
    as_json: AsJson = False,
) -> None:
    """SOLOv2 against PR-SOLOv2, binary against soft targets, grids and points-NMS, all trained alike.

    Example: `fairyring bench network ablation --out ablation --iterations 600`
    """
    from fairyring.app.bench.network.ablation import ablation_rows, variants
    from fairyring.app.bench.network.sets import rendered
    from fairyring.model.device import device_of

    with shown_on_stderr() as progress:
        test = rendered("paper", out, count=count, progress=progress)
        rows = ablation_rows(
            variants(iterations=iterations, crop=crop),
            folder=out,
            test=test,
            beds=train_beds,
            device=device_of(device),
            progress=progress,
        )
    print_rows("ablation", rows, as_json=as_json)


def _sets(folder: Path, count: int | None, real: Path | None, progress: Progress) -> list[LabelledPhotos]:
    """The rendered test beds of each preset, and the checked photos of ``real``."""
    from fairyring.app.bench.network.sets import TEST_BEDS, checked, rendered

    sets = [rendered(name, folder, count=count, progress=progress) for name in TEST_BEDS]
    return [*sets, *([] if real is None else [checked(real)])]


def _predicted(
    weights: Path | None, beds: Path | None, count: int | None, real: Path | None, device: str, *, fast: bool
) -> Iterator[tuple[LabelledPhotos, dict[str, Any]]]:
    """Each set of photos with the network's predictions for it."""
    from fairyring.app.bench.network.sets import TEST_BEDS, checked, rendered
    from fairyring.app.bench.network.tables import predicted_document

    detect = _detecting(weights, device, fast=fast)
    with _folder(beds) as folder, shown_on_stderr() as progress:
        for name in TEST_BEDS:
            photos = rendered(name, folder, count=count, progress=progress)
            yield photos, predicted_document(detect, photos, progress=progress)
        if real is not None:
            photos = checked(real)
            yield photos, predicted_document(detect, photos, progress=progress)


def _detecting(weights: Path | None, device: str, *, fast: bool) -> Callable[[Pixels], list[Detection]]:
    from fairyring.model.device import device_of
    from fairyring.model.network.weights import load_weights
    from fairyring.model.predict.predictor import PredictConfig, Predictor
    from fairyring.model.predict.scale import detect_at_its_scale
    from fairyring.model.predict.shipped import SHIPPED

    network, settings = load_weights(weights or SHIPPED).network, PredictConfig(passes=passes_of(fast=fast))
    return partial(detect_at_its_scale, Predictor(network, device=device_of(device), settings=settings))


@contextmanager
def _folder(given: Path | None) -> Iterator[Path]:
    if given is not None:
        yield given
        return
    with tempfile.TemporaryDirectory() as folder:
        yield Path(folder)
