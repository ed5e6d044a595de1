"""Short trainings and what their logs say."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import torch

from fairyring.model.network.weights import load_weights
from fairyring.model.train import log as train_log
from fairyring.model.train.data import Example
from fairyring.model.train.loop import FINAL, train
from fairyring.model.train.recipe import Recipe
from tests.support.discs import SHORT

CPU = torch.device("cpu")


def digest_after_training(examples: list[Example], out: Path, recipe: Recipe = SHORT, **options: Any) -> str:
    """Trains and returns the digest of the weights."""
    result = train(examples, [], out, recipe=recipe, device=CPU, workers=0, **options)
    assert result.weights == out / FINAL
    return load_weights(result.weights).digest


def logged(out: Path, key: str) -> list[tuple[int, float]]:
    """Every iteration whose line has the key, and what it says."""
    return [(entry["iteration"], entry[key]) for entry in train_log.read(out) if key in entry]


def environment(**more: str) -> dict[str, str]:
    """The environment of a training in a process of its own."""
    root = Path(__file__).parents[2]
    return {**os.environ, "PYTHONPATH": str(root), "OMP_NUM_THREADS": "1", **more}
