"""What the commands of ``fairyring bench network`` share: their options, and the photos they measure on."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fairyring.app.commands.network import passes_of

if TYPE_CHECKING:
    from fairyring.app.bench.network.sets import LabelledPhotos
    from fairyring.model.photo import Pixels
    from fairyring.model.predict.seen import Detection
    from fairyring.model.progress import Progress

Weights = Annotated[Path | None, typer.Option(help="Else the shipped ones.")]
Beds = Annotated[Path | None, typer.Option(help="Folder where the rendered beds are kept, and looked for.")]
Count = Annotated[int | None, typer.Option(min=1, help="Fewer beds, to see that it works.")]
Real = Annotated[Path | None, typer.Option(help="Folder of photos with checked.json, measured too.")]


def labelled_sets(
    folder: Path, count: int | None, real: Path | None, progress: Progress
) -> list[LabelledPhotos]:
    """The rendered test beds of each preset, and the checked photos of ``real``."""
    from fairyring.app.bench.network.sets import TEST_BEDS, checked, rendered

    sets = [rendered(name, folder, count=count, progress=progress) for name in TEST_BEDS]
    return [*sets, *([] if real is None else [checked(real)])]


@contextmanager
def folder_for_beds(given: Path | None) -> Iterator[Path]:
    """The folder that was given, else one for as long as the command runs."""
    if given is not None:
        yield given
        return
    with tempfile.TemporaryDirectory() as folder:
        yield Path(folder)


def detecting(weights: Path | None, device: str, *, fast: bool) -> Callable[[Pixels], list[Detection]]:
    """What detects caps in a photo with these weights, the shipped ones where none are named."""
    from fairyring.model.device import device_of
    from fairyring.model.network.weights import load_weights
    from fairyring.model.predict.predictor import PredictConfig, Predictor
    from fairyring.model.predict.scale import detect_at_its_scale
    from fairyring.model.predict.shipped import SHIPPED

    network, settings = load_weights(weights or SHIPPED).network, PredictConfig(passes=passes_of(fast=fast))
    return partial(detect_at_its_scale, Predictor(network, device=device_of(device), settings=settings))
