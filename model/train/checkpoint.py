"""Checkpoints: all that a training needs to go on as if it had never stopped."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import torch

from fairyring.model.errors import FairyringError
from fairyring.model.whole_files import written_whole

CHECKPOINT = "last.pt"


class CheckpointError(FairyringError):
    """A checkpoint that training cannot go on from."""


def save_checkpoint(folder: Path, state: dict[str, Any]) -> None:
    """Writes a checkpoint, whole or not at all: a kill leaves the old one. Raises CheckpointError."""
    try:
        with written_whole(folder / CHECKPOINT) as fresh:
            torch.save(state, fresh)
    except (OSError, RuntimeError) as error:
        raise CheckpointError(f"{folder / CHECKPOINT} cannot be written: {error}.") from error


def load_checkpoint(folder: Path, *, device: torch.device) -> dict[str, Any]:
    """What ``save_checkpoint`` wrote: tensors and plain values only. Raises CheckpointError."""
    path = folder / CHECKPOINT
    try:
        return torch.load(path, map_location=device, weights_only=True)
    except FileNotFoundError:
        raise CheckpointError(f"There is nothing to resume in {folder}; start without --resume.") from None
    # What is no checkpoint makes the unpickler raise whatever it stumbles over.
    except Exception as error:
        raise CheckpointError(f"{path} is damaged; start again without --resume.") from error
