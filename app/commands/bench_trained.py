"""``fairyring bench network``: the tables of networks that are trained for them, all alike."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from fairyring.app.commands.network import Device, Fast, OnDevice
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

commands = typer.Typer(rich_markup_mode=None)

Runs = Annotated[Path, typer.Option(help="Folder for the beds and the runs; runs there are gone on with.")]
Iterations = Annotated[int, typer.Option(min=1, help="Of every network.")]
TrainBeds = Annotated[int, typer.Option(min=1, help="Of each preset, to train on.")]
CropSide = Annotated[int, typer.Option(min=64, help="Side of the crops, photo pixels.")]


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
            sets=labelled_sets(out, count, real, progress),
            beds=train_beds,
            iterations=iterations,
            crop=crop,
            device=device_of(device),
            progress=progress,
        )
    print_rows("alike", rows, as_json=as_json)


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
        detector_of=lambda weights: detecting(weights, device, fast=fast),
        caps=labelled,
        iterations=iterations,
        device=device,
    )
    rows: list[dict[str, Any]] = []
    with folder_for_beds(beds) as kept, folder_for_beds(None) as folder, shown_on_stderr() as progress:
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


@commands.command()
def ladder(
    *,
    out: Runs,
    labels: Annotated[
        Path | None, typer.Option(help="COCO file of labelled photos to learn from as well; else none.")
    ] = None,
    iterations: Iterations = 600,
    train_beds: TrainBeds = 40,
    crop: CropSide = 256,
    count: Count = None,
    real: Real = None,
    device: OnDevice = Device.auto,
    as_json: AsJson = False,
) -> None:
    """What rims, real labels, resolution, two passes, quality and whole caps brought, all trained alike.

    Example: `fairyring bench network ladder --out ladder --labels corrected/instances.json --real photos`
    """
    from fairyring.app.bench.network.ladder import ladder_rows
    from fairyring.app.jobs.training_labels import labels_of_coco
    from fairyring.model.device import device_of

    with shown_on_stderr() as progress:
        rows = ladder_rows(
            folder=out,
            sets=labelled_sets(out, count, real, progress),
            real=labels_of_coco([labels], progress=progress).examples if labels else (),
            beds=train_beds,
            iterations=iterations,
            crop=crop,
            device=device_of(device),
            progress=progress,
        )
    print_rows("ladder", rows, as_json=as_json)
