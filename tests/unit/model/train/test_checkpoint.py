"""Checkpoints: whole or not at all, and never run."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest
import torch

from fairyring.model.train.checkpoint import CHECKPOINT, CheckpointError, load_checkpoint, save_checkpoint

CPU = torch.device("cpu")
STATE = {"network": {"x": torch.arange(4.0)}, "iteration": 7, "average": None, "best": "{}"}


def test_a_checkpoint_comes_back(tmp_path: Path) -> None:
    save_checkpoint(tmp_path, STATE)
    state = load_checkpoint(tmp_path, device=CPU)
    assert state.keys() == STATE.keys()
    assert state["iteration"] == 7
    assert state["average"] is None
    assert torch.equal(state["network"]["x"], torch.arange(4.0))
    assert [path.name for path in tmp_path.iterdir()] == [CHECKPOINT]


def test_a_save_that_is_cut_short_leaves_the_one_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    save_checkpoint(tmp_path, STATE)

    def fails(_state: object, path: Path) -> None:
        path.write_bytes(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(torch, "save", fails)
    with pytest.raises(CheckpointError, match=r"last\.pt cannot be written: .*No space left"):
        save_checkpoint(tmp_path, {"iteration": 8})
    assert load_checkpoint(tmp_path, device=CPU)["iteration"] == 7


def test_nothing_to_resume_is_said(tmp_path: Path) -> None:
    with pytest.raises(CheckpointError, match=f"nothing to resume in {tmp_path}"):
        load_checkpoint(tmp_path, device=CPU)


@pytest.mark.parametrize("content", [b"", b"hello", pickle.dumps({"iteration": 3}, protocol=2)])
def test_a_damaged_checkpoint_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / CHECKPOINT).write_bytes(content)
    with pytest.raises(CheckpointError, match="damaged"):
        load_checkpoint(tmp_path, device=CPU)


@pytest.mark.parametrize("share", [0.1, 0.6, 0.99])
def test_a_checkpoint_that_was_cut_off_is_damaged(tmp_path: Path, share: float) -> None:
    save_checkpoint(tmp_path, STATE)
    content = (tmp_path / CHECKPOINT).read_bytes()
    (tmp_path / CHECKPOINT).write_bytes(content[: int(share * len(content))])
    with pytest.raises(CheckpointError, match="damaged"):
        load_checkpoint(tmp_path, device=CPU)


def test_code_in_a_checkpoint_is_not_run(tmp_path: Path) -> None:
    marker = tmp_path / "was-run"

    class Harmful:
        def __reduce__(self) -> tuple[object, tuple[Path]]:
            return Path.mkdir, (marker,)

    torch.save({"network": Harmful()}, tmp_path / CHECKPOINT)
    with pytest.raises(CheckpointError):
        load_checkpoint(tmp_path, device=CPU)
    assert not marker.exists()
