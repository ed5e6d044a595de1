"""How a network is trained: by the paper's recipe (section 6.1), or as a TOML file says otherwise."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import msgspec
from msgspec import Struct, field

from fairyring.model.errors import FairyringError
from fairyring.model.network.config import GROUPS, LEVELS, OPTIONAL, NetworkConfig
from fairyring.model.train.crops import CropConfig

Learns = Literal["network", "second look"]


class RecipeError(FairyringError):
    """A recipe that cannot be followed; the sentence names the file and the setting."""


class Recipe(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """All settings of a training; with the data and the base weights they decide its result."""

    network: NetworkConfig = field(default_factory=NetworkConfig)
    crop: CropConfig = field(default_factory=CropConfig)
    learns: Learns = "network"
    """``second look`` keeps all that the base weights know, and teaches (adding it where there is none) only
    how good masks are and where whole ellipses lie."""
    targets: Literal["soft", "binary"] = "soft"
    iterations: int = 5000
    batch: int = 4
    accumulate: int = 1
    """Batches whose gradients are added up before a step; an iteration is a step."""
    optimiser: Literal["sgd", "adamw"] = "sgd"
    rate: float = 0.01
    momentum: float = 0.9
    """Momentum of SGD."""
    weight_decay: float = 1e-4
    warm_up: int = 500
    """Iterations over which the rate rises evenly from a thousandth of itself."""
    schedule: Literal["steps", "cosine"] = "steps"
    """``steps``: a tenth from 75 % of the iterations and a hundredth from 92 %; ``cosine``: down to 0."""
    clip: float = 35.0
    """Largest norm of the gradient."""
    backbone_rate: float = 1.0
    """Factor on the rate for the backbone."""
    frozen: int = 1
    """Stages of the backbone, the stem and that up to C2 first, that stay as ImageNet left them."""
    average: float = 0.998
    """Decay of the exponential moving average of the weights, which is what is saved; 0 for none."""
    bf16: bool = False
    """Whether to train in mixed precision, bfloat16."""
    validate_every: int = 500
    validate_images: int = 24
    save_every: int = 200
    seed: int = 0


def read_recipe(path: Path) -> Recipe:
    """A recipe from a TOML file; what it does not name stays as in the paper. Raises RecipeError."""
    try:
        recipe = msgspec.toml.decode(path.read_bytes(), type=Recipe)
    except OSError as error:
        raise RecipeError(f"{path} cannot be read: {error.strerror or error}.") from error
    except (msgspec.MsgspecError, UnicodeDecodeError) as error:
        raise RecipeError(f"{path} is not a recipe: {error}.") from error
    return checked(recipe, where=str(path))


def checked(recipe: Recipe, *, where: str) -> Recipe:
    """The recipe, if it can be followed; RecipeError otherwise."""
    least = {
        "iterations": recipe.iterations,
        "batch": recipe.batch,
        "accumulate": recipe.accumulate,
        "validate_every": recipe.validate_every,
        "save_every": recipe.save_every,
    }
    for name, value in least.items():
        if value < 1:
            raise RecipeError(f"{where}: {name} is {value}; it must be 1 or more.")
    if recipe.seed < 0:
        raise RecipeError(f"{where}: seed is {recipe.seed}; it must be 0 or more.")
    if not recipe.rate > 0 or not recipe.clip > 0:
        raise RecipeError(f"{where}: rate and clip must be more than 0.")
    if not 0 <= recipe.average < 1:
        raise RecipeError(f"{where}: average is {recipe.average}; it must be at least 0 and below 1.")
    if not 0 <= recipe.frozen <= 4:
        raise RecipeError(f"{where}: frozen is {recipe.frozen}; a backbone has four stages.")
    if recipe.weight_decay < 0 or recipe.warm_up < 0:
        raise RecipeError(f"{where}: weight_decay and warm_up must be 0 or more.")
    _check_network(recipe.network, where)
    side, multiple = recipe.crop.side, recipe.network.multiple
    if side < multiple or side % multiple:
        raise RecipeError(f"{where}: crop.side is {side}; it must be a multiple of {multiple}.")
    if not 0 < recipe.crop.scale[0] <= recipe.crop.scale[1]:
        raise RecipeError(f"{where}: crop.scale must be two factors above 0, the smaller first.")
    return recipe


def _check_network(network: NetworkConfig, where: str) -> None:
    widths = {
        "fpn_channels": network.fpn_channels,
        "head_channels": network.head_channels,
        "kernel_channels": network.kernel_channels,
    }
    for name, width in widths.items():
        if width < GROUPS or width % GROUPS:
            raise RecipeError(f"{where}: network.{name} is {width}; it must be a multiple of {GROUPS}.")
    if network.reduction < 1 or network.reduction & (network.reduction - 1):
        raise RecipeError(f"{where}: network.reduction is {network.reduction}; it must be 1, 2, 4 …")
    if min(network.grids) < 1 or min(network.head_convs, network.point_channels) < 1:
        raise RecipeError(f"{where}: network.grids, head_convs and point_channels must be 1 or more.")
    for name in OPTIONAL:
        if getattr(network, name) < 0:
            raise RecipeError(f"{where}: network.{name} is below 0; 0 is none.")
    if network.second_look and (network.point_rend != "instance" or 2 * network.second_look % GROUPS):
        raise RecipeError(
            f"{where}: network.second_look must be a multiple of {GROUPS // 2}, "
            'and goes with point_rend = "instance" alone.'
        )
    if len(network.scale_ranges) != LEVELS or any(low > high for low, high in network.scale_ranges):
        raise RecipeError(
            f"{where}: network.scale_ranges must be {LEVELS} pairs of sizes, the smaller first."
        )
