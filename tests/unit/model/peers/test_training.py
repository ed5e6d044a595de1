"""Both peers learn drawn discs, and a training goes on where it stopped."""

from __future__ import annotations

from pathlib import Path

import pytest
import torch
from msgspec.structs import replace

from fairyring.model.geometry.raster import mask_of_outline, mask_of_rle
from fairyring.model.peers.detecting import detect
from fairyring.model.peers.training import PEERS, WEIGHTS, trained_peer
from fairyring.model.train.data import read_rgb
from tests.support.discs import RECIPE, SHORT, drawn_examples

CPU = torch.device("cpu")
ITERATIONS = {"Mask R-CNN": 50, "YOLACT": 90}


class StoppedError(Exception):
    """Stands for a kill."""


@pytest.mark.parametrize("name", PEERS)
def test_a_peer_learns_discs_by_heart(name: str, tmp_path: Path) -> None:
    examples = drawn_examples(tmp_path)
    recipe = replace(RECIPE, iterations=ITERATIONS[name])
    network = trained_peer(name, examples, tmp_path / "run", recipe=recipe, device=CPU)
    for example in examples:
        photo = read_rgb(example.path)
        height, width = photo.shape[:2]
        found = [cap for cap in detect(photo, network=network) if cap.score >= 0.5]
        for cap in example.caps:
            truly = mask_of_outline(cap, height=height, width=width)
            seen = [mask_of_rle(each.rle) for each in found]
            assert max((truly & mask).sum() / (truly | mask).sum() for mask in seen) > 0.7


@pytest.mark.parametrize("name", PEERS)
def test_a_training_that_was_stopped_ends_as_one_that_was_not(name: str, tmp_path: Path) -> None:
    examples = drawn_examples(tmp_path)

    def stop(done: int, _total: int, _what: str) -> None:
        if done == 3:
            raise StoppedError

    trained_peer(name, examples, tmp_path / "whole", recipe=SHORT, device=CPU)
    with pytest.raises(StoppedError):
        trained_peer(name, examples, tmp_path / "parts", recipe=SHORT, device=CPU, progress=stop)
    assert not (tmp_path / "parts" / WEIGHTS).exists()
    trained_peer(name, examples, tmp_path / "parts", recipe=SHORT, device=CPU)
    whole, parts = (tmp_path / folder / WEIGHTS for folder in ("whole", "parts"))
    assert whole.read_bytes() == parts.read_bytes()


def test_what_was_trained_is_not_trained_again(tmp_path: Path) -> None:
    examples = drawn_examples(tmp_path)
    trained_peer("YOLACT", examples, tmp_path / "run", recipe=SHORT, device=CPU)
    before = (tmp_path / "run" / WEIGHTS).stat().st_mtime_ns
    trained_peer("YOLACT", [], tmp_path / "run", recipe=SHORT, device=CPU)
    assert (tmp_path / "run" / WEIGHTS).stat().st_mtime_ns == before
