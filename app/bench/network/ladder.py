"""What each step of the shipped weights' making brought, every network trained alike."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import torch
from msgspec.structs import replace

from fairyring.app.bench.network.ablation import trained_variant, variants
from fairyring.app.bench.network.sets import LabelledPhotos, examples_of, rendered_for_training
from fairyring.app.bench.network.tables import centre_rows, predicted_document, success_rows
from fairyring.model.network.config import NetworkConfig
from fairyring.model.network.weights import load_weights
from fairyring.model.predict.passes import ONE_PASS, TWO_PASSES, Pass
from fairyring.model.predict.predictor import PredictConfig, Predictor
from fairyring.model.predict.scale import detect_at_its_scale
from fairyring.model.predict.shipped import SECOND_LOOK
from fairyring.model.progress import Progress
from fairyring.model.scene.settings import Settings
from fairyring.model.train.data import Example
from fairyring.model.train.loop import FINAL
from fairyring.model.train.recipe import Recipe, read_recipe
from fairyring.model.train.second_look import with_second_look

SHIPPED_KIND = "PR-SOLOv2 (A), soft targets"
"""The variant of the ablation that the shipped weights are of."""
MASK_FIGURES = ("AP", "S50", "S75", "IoU85", "excursion")
SECOND_SHARE = 3
"""The second look learns for one in so many iterations: it is small, and all else is kept."""


@dataclass(frozen=True, kw_only=True)
class Step:
    """A row of the ladder."""

    name: str
    weights: Path
    passes: tuple[Pass, ...] = ONE_PASS
    wholes: bool = False
    """Whether centres heed the whole ellipses that the network says."""


def ladder_rows(
    *,
    folder: Path,
    sets: Sequence[LabelledPhotos],
    real: Sequence[Example],
    beds: int,
    iterations: int,
    crop: int,
    device: torch.device,
    progress: Progress,
) -> list[dict[str, Any]]:
    """Trains each step's network in ``folder``, going on with what is there, and measures it on every set.

    All start from the same backbone, for as many iterations, with the same seed, on ``beds`` of each preset;
    ``real`` are labelled photos (none: that step is left out). Each step has what those above it have, but
    for whole resolution, which costs four times the computing and stands aside.
    """
    recipe = variants(iterations=iterations, crop=crop)[SHIPPED_KIND]
    learn = partial(trained_variant, folder=folder, device=device, progress=progress)
    crisp_beds = rendered_for_training(folder / "crisp", beds, progress, changed=crisp)
    soft_beds = rendered_for_training(folder, beds, progress)
    steps = _steps(learn, recipe, crisp_beds=_examples(crisp_beds), soft_beds=_examples(soft_beds), real=real)
    return [_row(step, photos, device=device, progress=progress) for step in steps for photos in sets]


def crisp(settings: Settings) -> Settings:
    """Beds as they were rendered at first: no light between or in caps, no flesh in gaps, all in focus."""
    return replace(
        settings,
        growth=replace(settings.growth, fused=(0.0, 0.0), tucked=0.0),
        flesh=replace(settings.flesh, interreflection=(0.0, 0.0), translucency=(0.0, 0.0)),
        camera=replace(settings.camera, defocus=0.0),
    )


def whole_resolution(network: NetworkConfig) -> NetworkConfig:
    """The network with each photo pixel an input pixel; its levels learn caps of the same sizes as before."""
    doubled = tuple((low * 2, high * 2) for low, high in network.scale_ranges)
    return replace(network, reduction=1, scale_ranges=doubled)


def _steps(
    learn: Callable[..., Path],
    recipe: Recipe,
    *,
    crisp_beds: list[Example],
    soft_beds: list[Example],
    real: Sequence[Example],
) -> list[Step]:
    weights = learn("crisp rims", recipe, crisp_beds) / FINAL
    steps = [Step(name="crisp rims", weights=weights)]
    weights = learn("soft rims", recipe, soft_beds) / FINAL
    steps.append(Step(name="soft rims", weights=weights))
    whole = replace(recipe, network=whole_resolution(recipe.network))
    aside = learn("whole resolution", whole, soft_beds) / FINAL
    steps.append(Step(name="whole resolution (aside)", weights=aside))
    if real:
        weights = learn("real labels", recipe, [*soft_beds, *real]) / FINAL
        steps.append(Step(name="real labels", weights=weights))
    steps.append(Step(name="two passes", weights=weights, passes=TWO_PASSES))
    second = _second_look(recipe)
    base = with_second_look(load_weights(weights).network, seed=second.seed)
    # As the shipped one: of rendered beds every whole outline is known.
    weights = learn("second look", replace(second, network=base.config), soft_beds, base=base) / FINAL
    steps.append(Step(name="quality", weights=weights, passes=TWO_PASSES))
    steps.append(Step(name="whole caps", weights=weights, passes=TWO_PASSES, wholes=True))
    return steps


def _examples(sets: Sequence[LabelledPhotos]) -> list[Example]:
    return [example for photos in sets for example in examples_of(photos)]


def _second_look(usual: Recipe) -> Recipe:
    iterations = max(1, usual.iterations // SECOND_SHARE)
    recipe = read_recipe(SECOND_LOOK)
    return replace(
        recipe,
        iterations=iterations,
        warm_up=min(recipe.warm_up, iterations // 6),
        crop=replace(recipe.crop, side=usual.crop.side),
        validate_images=0,
    )


def _row(step: Step, photos: LabelledPhotos, *, device: torch.device, progress: Progress) -> dict[str, Any]:
    settings = PredictConfig(passes=step.passes)
    predictor = Predictor(load_weights(step.weights).network, device=device, settings=settings)
    predicted = predicted_document(partial(detect_at_its_scale, predictor), photos, progress=progress)
    if not step.wholes:
        predicted["annotations"] = [cap | {"likely": None} for cap in predicted["annotations"]]
    found = {row["caps_of"]: row for row in success_rows(predicted, photos)}
    centres = centre_rows(predicted, photos)[-1]
    return {
        "step": step.name,
        "set": photos.name,
        **{name: found["all"][name] for name in MASK_FIGURES},
        "S50_under_30": found.get("size under 30 px", {}).get("S50"),
        "CDR_%_mean": centres["CDR_%_mean"],
        "CDR_%_median": centres["median"],
        "matched": centres["matched"],
    }
