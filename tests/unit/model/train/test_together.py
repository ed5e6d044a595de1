"""Two processes train as one."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from fairyring.model.network.weights import load_weights
from fairyring.model.train.loop import FINAL
from tests.support.small_trainings import environment, logged

TOGETHER = """
import sys
from pathlib import Path
import torch
from msgspec.structs import replace
from fairyring.model.train.data import Example
from fairyring.model.geometry.shapes import Circle, polygon_of_shape
from fairyring.model.train.loop import train
from tests.support.discs import SHORT, drawn_examples
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
        env=environment(),
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
