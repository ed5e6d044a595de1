"""A network that has learnt two drawn photos by heart, trained once for all tests."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
import torch

from fairyring.model.train.data import Example
from fairyring.model.train.loop import TrainingProgress, TrainResult, train
from tests.support.discs import RECIPE, drawn_examples


@dataclass(frozen=True)
class Learnt:
    """The training and what it was about."""

    examples: list[Example]
    result: TrainResult
    progress: list[TrainingProgress]


@pytest.fixture(scope="session")
def learnt(tmp_path_factory: pytest.TempPathFactory) -> Learnt:
    folder = tmp_path_factory.mktemp("learnt")
    examples = drawn_examples(folder)
    progress: list[TrainingProgress] = []
    result = train(
        examples,
        examples,
        folder / "out",
        recipe=RECIPE,
        device=torch.device("cpu"),
        workers=0,
        notes={"source": "two drawn photos"},
        report=progress.append,
    )
    return Learnt(examples, result, progress)
