"""Table 1: what each part of the network brings, every variant trained alike on the same beds."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import torch
from msgspec.structs import replace

from fairyring.app.bench.network.sets import LabelledPhotos, examples_of, rendered_for_training
from fairyring.app.bench.network.tables import MASK_FIGURES, PAPER_MASKS, mask_row, predicted_document
from fairyring.model.coco.document import document_of
from fairyring.model.evaluate.masks import evaluate_masks
from fairyring.model.network.decode import DecodeConfig
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.network.weights import load_weights
from fairyring.model.photo import Pixels
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.seen import Detection
from fairyring.model.predict.shipped import RECIPE
from fairyring.model.progress import Progress
from fairyring.model.train.data import Example
from fairyring.model.train.loop import FINAL, TrainingProgress, train
from fairyring.model.train.recipe import Recipe, checked, read_recipe

PAPER_GRIDS = (40, 36, 24, 16, 12)
WINDOWS = (2, 1)
"""Window of points-NMS in grid cells; 1 means no points-NMS."""
PAPER_SOLOV2 = {"AP": 0.9028}


def variants(*, iterations: int, crop: int) -> dict[str, Recipe]:
    """The shipped weights' recipe in each of the ways that are compared, for so many iterations.

    ``crop``: side of the crops, photo pixels. Raises RecipeError where it does not fit the network.
    """
    recipe = read_recipe(RECIPE)
    recipe = replace(
        recipe,
        iterations=iterations,
        warm_up=min(recipe.warm_up, iterations // 6),
        crop=replace(recipe.crop, side=crop),
        validate_images=0,
    )
    checked(recipe, where="--crop")
    network = recipe.network
    off, semantic = replace(network, point_rend="off"), replace(network, point_rend="semantic")
    return {
        "SOLOv2, binary targets": replace(recipe, network=off, targets="binary"),
        "SOLOv2, soft targets": replace(recipe, network=off),
        "PR-SOLOv2 (A), binary targets": replace(recipe, targets="binary"),
        "PR-SOLOv2 (A), soft targets": recipe,
        "PR-SOLOv2 (A), soft, no detail": replace(recipe, network=replace(network, detail_channels=0)),
        "PR-SOLOv2 (A), soft, paper's grids": replace(recipe, network=replace(network, grids=PAPER_GRIDS)),
        "PR-SOLOv2 (B), soft targets": replace(recipe, network=semantic),
    }


def ablation_rows(
    recipes: dict[str, Recipe],
    *,
    folder: Path,
    test: LabelledPhotos,
    beds: int,
    device: torch.device,
    progress: Progress,
) -> list[dict[str, Any]]:
    """Trains each variant in ``folder``, going on with what is there, and measures it on ``test``.

    Every one sees the same ``beds`` of each preset, the same number of iterations and the same seed.
    """
    examples = [
        example for photos in rendered_for_training(folder, beds, progress) for example in examples_of(photos)
    ]
    rows: list[dict[str, Any]] = [
        {"network": f"paper: {name}"} | {key: figures.get(key) for key in MASK_FIGURES} | {"window": None}
        for name, figures in (("SOLOv2", PAPER_SOLOV2), ("PR-SOLOv2", PAPER_MASKS))
    ]
    for name, recipe in recipes.items():
        out = trained_variant(name, recipe, examples, folder=folder, device=device, progress=progress)
        predictor = Predictor(load_weights(out / FINAL).network, device=device)
        for window in WINDOWS:
            detect = partial(_read, predictor, settings=DecodeConfig(window=window))
            predicted = predicted_document(detect, test, progress=progress)
            figures = evaluate_masks(document_of(predicted), document_of(test.document))
            rows.append(mask_row(name, figures) | {"window": window})
    return rows


def _read(predictor: Predictor, photo: Pixels, *, settings: DecodeConfig) -> list[Detection]:
    return predictor.read(predictor.see(photo), settings)


def trained_variant(
    name: str,
    recipe: Recipe,
    examples: list[Example],
    *,
    folder: Path,
    device: torch.device,
    progress: Progress,
    base: PRSOLOv2 | None = None,
) -> Path:
    """Trains a variant in a folder of its own in ``folder`` unless that was done, and returns that folder.

    ``base`` is trained further where given (and changed), else a new network is.
    """

    def report(step: TrainingProgress) -> None:
        progress(step.iteration, step.iterations, f"training {name}")

    out = folder / f"{recipe.iterations} {name}".replace(" ", "_").replace(",", "")
    if not (out / FINAL).exists():
        resume = (out / "last.pt").exists()
        train(examples, [], out, recipe=recipe, device=device, base=base, resume=resume, report=report)
    return out
