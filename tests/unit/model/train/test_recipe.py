"""Recipes: the paper's by default, and what cannot be followed is refused by file and setting."""

from __future__ import annotations

from pathlib import Path

import pytest

from fairyring.model.network.config import SIZES
from fairyring.model.train.recipe import Recipe, RecipeError, checked, read_recipe


def read(tmp_path: Path, text: str) -> Recipe:
    path = tmp_path / "recipe.toml"
    path.write_text(text)
    return read_recipe(path)


def test_the_default_is_the_papers(tmp_path: Path) -> None:
    recipe = read(tmp_path, "")
    assert recipe == Recipe()
    assert (recipe.optimiser, recipe.rate, recipe.momentum, recipe.weight_decay) == ("sgd", 0.01, 0.9, 1e-4)
    assert (recipe.batch, recipe.iterations, recipe.warm_up, recipe.clip) == (4, 5000, 500, 35.0)
    assert recipe.network == SIZES["lite0"]
    assert recipe.targets == "soft"


def test_what_is_named_is_changed_and_the_rest_stays(tmp_path: Path) -> None:
    recipe = read(
        tmp_path,
        'iterations = 10\nschedule = "cosine"\n[crop]\nside = 128\nscale = [0.5, 2.0]\n'
        "[network]\ngrids = [40, 36, 24, 16, 12]\n",
    )
    assert recipe.iterations == 10
    assert recipe.crop.scale == (0.5, 2.0)
    assert recipe.network.grids == (40, 36, 24, 16, 12)
    assert recipe.batch == 4


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("iterations = 0", "iterations is 0; it must be 1 or more"),
        ("batch = -1", "batch is -1"),
        ("accumulate = 0", "accumulate is 0"),
        ("validate_every = 0", "validate_every is 0"),
        ("save_every = 0", "save_every is 0"),
        ("rate = 0.0", "rate and clip must be more than 0"),
        ("rate = nan", "rate and clip must be more than 0"),
        ("clip = -3.0", "rate and clip must be more than 0"),
        ("average = 1.0", "average is 1.0"),
        ("frozen = 5", "frozen is 5"),
        ("seed = -1", "seed is -1"),
        ("[crop]\nside = 100", "crop.side is 100; it must be a multiple of 64"),
        ("[crop]\nside = 0", "crop.side is 0"),
        ("[crop]\nside = 96\n[network]\nreduction = 2", "crop.side is 96; it must be a multiple of 64"),
        ("[crop]\nscale = [2.0, 1.0]", "crop.scale must be two factors"),
        ("[crop]\nscale = [0.0, 1.0]", "crop.scale must be two factors"),
        ("weight_decay = -0.1", "weight_decay and warm_up must be 0 or more"),
        ("[network]\nhead_channels = 48", "network.head_channels is 48; it must be a multiple of 32"),
        ("[network]\nreduction = 3", "network.reduction is 3; it must be 1, 2, 4"),
        ("[network]\ngrids = [40, 36, 24, 16, 0]", "network.grids, head_convs and point_channels"),
        ("[network]\ndetail_channels = -1", "network.detail_channels is below 0"),
        ("[network]\nscale_ranges = [[1, 96]]", "network.scale_ranges must be 5 pairs"),
        ("iteration = 10", "unknown field `iteration`"),
        ("[network]\ngrid = 1", "unknown field `grid`"),
        ('optimiser = "lbfgs"', "lbfgs"),
        ('rate = "fast"', r"rate"),
        ("[network]\ngrids = [1, 2]", r"network\.grids"),
        ("iterations 10", "is not a recipe"),
    ],
)
def test_what_cannot_be_followed_is_named(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(RecipeError, match=says) as caught:
        read(tmp_path, text)
    assert str(tmp_path / "recipe.toml") in str(caught.value)


def test_a_file_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    with pytest.raises(RecipeError, match=r"none\.toml cannot be read: No such file"):
        read_recipe(tmp_path / "none.toml")
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(RecipeError, match=r"bytes\.toml is not a recipe"):
        read_recipe(tmp_path / "bytes.toml")


def test_the_recipe_of_the_shipped_weights_can_be_followed() -> None:
    path = Path(__file__).parents[4] / "model" / "weights" / "lite0.toml"
    assert read_recipe(path).network == SIZES["lite0"]


@pytest.mark.parametrize("name", SIZES)
def test_every_size_fits_the_papers_recipe(name: str) -> None:
    assert checked(Recipe(network=SIZES[name]), where="here").network == SIZES[name]
