"""Training goes on after a stop or a kill as if nothing had been, and only where it may."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pytest
from msgspec.structs import replace

from fairyring.model.network.weights import digest_of
from fairyring.model.train import log as train_log
from fairyring.model.train.checkpoint import CheckpointError, load_checkpoint
from fairyring.model.train.data import Example
from fairyring.model.train.loop import TrainError, TrainingProgress, train
from tests.support.discs import SHORT
from tests.support.small_trainings import CPU, digest_after_training, environment, logged


class StopError(Exception):
    """What somebody's Ctrl+C might be."""


def stop_after(iteration: int) -> Any:
    def report(progress: TrainingProgress) -> None:
        if progress.iteration == iteration:
            raise StopError

    return report


def test_a_run_stopped_and_resumed_is_one_that_never_stopped(examples: list[Example], tmp_path: Path) -> None:
    through = digest_after_training(examples, tmp_path / "through")
    with pytest.raises(StopError):
        digest_after_training(examples, tmp_path / "halves", report=stop_after(3))
    assert load_checkpoint(tmp_path / "halves", device=CPU)["iteration"] == 3
    assert digest_after_training(examples, tmp_path / "halves", resume=True) == through
    losses = [logged(tmp_path / name, "mask") for name in ("through", "halves")]
    assert losses[0] == losses[1]
    assert [iteration for iteration, _ in losses[0]] == [1, 2, 3, 4, 5]
    card = json.loads((tmp_path / "halves" / "run.json").read_text())["circumstances"]
    assert (card["versions"]["torch"], card["processes"]) == (version("torch"), 1)
    assert card["device"].startswith("cpu")
    assert card["seconds"] > 0
    states = [load_checkpoint(tmp_path / name, device=CPU) for name in ("through", "halves")]
    assert len({digest_of(state["network"], "") for state in states}) == 1


KILLED = """
import sys
from pathlib import Path
import torch
from fairyring.model.train.loop import train
from tests.support.discs import SHORT, drawn_examples
torch.set_num_threads(1)
folder = Path(sys.argv[1])
train(drawn_examples(folder), [], folder / "out", recipe=SHORT, device=torch.device("cpu"), workers=0,
      report=lambda progress: print(progress.iteration, flush=True))
"""


@pytest.mark.timeout(200)
def test_a_killed_run_goes_on_from_its_last_checkpoint(examples: list[Example], tmp_path: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", KILLED, str(tmp_path)], stdout=subprocess.PIPE, text=True, env=environment()
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
    assert digest_after_training(examples, out, resume=True) == digest_after_training(
        examples, tmp_path / "through"
    )
    assert logged(out, "category") == logged(tmp_path / "through", "category")


def test_a_validation_that_was_stopped_is_made_up_for(examples: list[Example], tmp_path: Path) -> None:
    recipe = replace(SHORT, iterations=2, validate_every=1)

    def stop_in_the_last(progress: TrainingProgress) -> None:
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


def test_a_folder_in_use_is_refused_and_left_alone(examples: list[Example], tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "thesis.txt").write_text("all of it")
    with pytest.raises(TrainError, match="out is not empty; give a new folder, or --resume"):
        digest_after_training(examples, out)
    assert [path.name for path in out.iterdir()] == ["thesis.txt"]
    with pytest.raises(CheckpointError, match="nothing to resume"):
        digest_after_training(examples, out, resume=True)
    with pytest.raises(TrainError, match=r"thesis\.txt cannot be made"):
        digest_after_training(examples, out / "thesis.txt")


def test_a_run_of_another_recipe_is_not_resumed(examples: list[Example], tmp_path: Path) -> None:
    out = tmp_path / "out"
    digest_after_training(examples, out, replace(SHORT, iterations=1))
    wider = replace(SHORT, network=replace(SHORT.network, kernel_channels=64))
    for other in (wider, replace(SHORT, optimiser="sgd", frozen=2)):
        with pytest.raises(TrainError, match="had another recipe"):
            digest_after_training(examples, out, other, resume=True)


def test_a_finished_run_that_is_resumed_is_finished(examples: list[Example], tmp_path: Path) -> None:
    recipe = replace(SHORT, iterations=2)
    first = digest_after_training(examples, tmp_path / "out", recipe)
    assert digest_after_training(examples, tmp_path / "out", recipe, resume=True) == first
    longer = replace(SHORT, iterations=3)
    digest_after_training(examples, tmp_path / "out", longer, resume=True)
    assert [iteration for iteration, _ in logged(tmp_path / "out", "rate")] == [1, 2, 3]
