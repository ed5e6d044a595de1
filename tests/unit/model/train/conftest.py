"""Drawn photos to train on, with sums that are the same everywhere."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
import torch

from fairyring.model.train.data import Example
from tests.support.discs import drawn_examples


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
