"""Batches: the same each time, every example in its turn, and targets by their definition."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
import torch
from msgspec.structs import replace
from torch import Tensor

from fairyring.model.geometry.shapes import Circle, polygon_of_shape
from fairyring.model.network.objective import Batch
from fairyring.model.network.targets import EMPTY, IGNORED
from fairyring.model.photo import PhotoError
from fairyring.model.train.crops import CropConfig
from fairyring.model.train.data import Batches, DataError, Example, SampleConfig
from tests.support.small_networks import TINY

SETTINGS = SampleConfig(
    crop=CropConfig(side=64, most_gain=0.1, most_noise=5, scale=(0.8, 1.2)),
    network=TINY,
    batch=3,
    soft=True,
    seed=7,
)
STILL = CropConfig(side=64, most_rotation_deg=0, most_brightness=0)


@pytest.fixture(scope="module")
def examples(tmp_path_factory: pytest.TempPathFactory) -> list[Example]:
    """Ten photos, each of one grey level of its own."""
    folder = tmp_path_factory.mktemp("photos")
    made = []
    for nth in range(10):
        path = folder / f"{nth}.png"
        cv2.imwrite(str(path), np.full((64, 96, 3), 10 + 20 * nth, np.uint8))
        caps = [[polygon_of_shape(Circle(30 + nth, 32, 14))], [polygon_of_shape(Circle(62.5, 30, 12))]]
        made.append(Example(path=path, width=96, height=64, caps=caps))
    return made


def tensors(batch: Batch) -> list[Tensor]:
    return [batch.photos, batch.origins, batch.masks, batch.targets, *batch.cells]


def test_a_batch_is_the_same_whatever_came_before(examples: list[Example]) -> None:
    first, second = (Batches(examples, SETTINGS, count=50) for _ in range(2))
    for nth in range(5):
        _ = first[nth]
    for mine, other in zip(tensors(first[31]), tensors(second[31]), strict=True):
        assert torch.equal(mine, other)
    assert not torch.equal(second[31].photos, second[32].photos)
    assert len(first) == 50


def test_another_seed_is_another_batch(examples: list[Example]) -> None:
    other = SampleConfig(crop=SETTINGS.crop, network=TINY, batch=3, soft=True, seed=8)
    assert not torch.equal(
        Batches(examples, SETTINGS, count=5)[0].photos, Batches(examples, other, count=5)[0].photos
    )


def test_every_example_is_seen_once_in_a_round(examples: list[Example]) -> None:
    settings = SampleConfig(crop=STILL, network=TINY, batch=3, soft=True, seed=1)
    batches = Batches(examples, settings, count=20)
    seen = [int(photo.max()) for nth in range(20) for photo in batches[nth].photos]
    rounds = [seen[first : first + 10] for first in range(0, 60, 10)]
    levels = [10 + 20 * nth for nth in range(10)]
    assert all(sorted(one) == levels for one in rounds)
    assert len({tuple(one) for one in rounds}) > 1


def test_shapes_are_those_the_network_takes(examples: list[Example]) -> None:
    batch = Batches(examples, SETTINGS, count=1)[0]
    assert batch.photos.shape == (3, 3, 64, 64)
    assert batch.photos.dtype == torch.uint8
    assert batch.origins.shape == (3, 2)
    count = sum(batch.counts)
    assert batch.masks.shape == (count, 64, 64)
    assert batch.targets.shape == (count, 16, 16)
    assert [tuple(cells.shape[1:]) for cells in batch.cells] == [(4, 4), (3, 3), (2, 2), (1, 1), (1, 1)]
    assert [len(caps.masks) for caps in batch.caps] == batch.counts


def test_a_cell_learns_a_cap_of_its_own_photo(examples: list[Example]) -> None:
    batch = Batches(examples, SETTINGS, count=1)[0]
    owners = torch.arange(3).repeat_interleave(torch.tensor(batch.counts))
    for cells in batch.cells:
        image, _, _ = (cells >= 0).nonzero().unbind(1)
        assert torch.equal(owners[cells[cells >= 0]], image)
    assert any((cells >= 0).any() for cells in batch.cells)


def test_channels_are_red_green_and_blue(tmp_path: Path) -> None:
    path = tmp_path / "red.png"
    cv2.imwrite(str(path), np.full((64, 64, 3), (0, 0, 200), np.uint8))
    example = Example(path=path, width=64, height=64, caps=[[polygon_of_shape(Circle(32, 32, 20))]])
    settings = SampleConfig(crop=STILL, network=TINY, batch=1, soft=True, seed=0)
    assert Batches([example], settings, count=1)[0].photos[0, :, 5, 5].tolist() == [200, 0, 0]


@pytest.mark.parametrize("reduction", [1, 2])
def test_targets_are_means_over_cells_and_their_halves(examples: list[Example], reduction: int) -> None:
    network = replace(TINY, reduction=reduction)
    stride = 4 * reduction
    soft, binary = (
        Batches(
            examples,
            SampleConfig(crop=SETTINGS.crop, network=network, batch=2, soft=soft, seed=3),
            count=1,
        )[0]
        for soft in (True, False)
    )
    for mask, mean, half in zip(soft.masks.numpy(), soft.targets, binary.targets, strict=True):
        side = 64 // stride
        cells = mask.reshape(side, stride, side, stride).sum(axis=(1, 3)) / stride**2
        np.testing.assert_array_equal(mean.numpy(), cells.astype(np.float32))
        np.testing.assert_array_equal(half.numpy(), cells >= 0.5)


def test_ignored_regions_are_not_learnt(examples: list[Example]) -> None:
    one = examples[0]
    region = [[0.0, 0.0, 96.0, 0.0, 96.0, 64.0, 0.0, 64.0]]
    example = Example(path=one.path, width=96, height=64, caps=one.caps, ignored=[region])
    settings = SampleConfig(crop=STILL, network=TINY, batch=1, soft=True, seed=0)
    batch = Batches([example], settings, count=1)[0]
    for cells in batch.cells:
        assert (cells != EMPTY).all()
    assert (batch.cells[0] == IGNORED).sum() + (batch.cells[0] >= 0).sum() == 16
    assert batch.counts == [2]


def test_examples_without_a_labelled_cap_are_refused(examples: list[Example]) -> None:
    bare = Example(path=examples[0].path, width=96, height=64, caps=[])
    for none in (
        [],
        [bare],
        [Example(path=bare.path, width=96, height=64, caps=[], ignored=examples[0].caps)],
    ):
        with pytest.raises(DataError, match="No cap is labelled"):
            Batches(none, SETTINGS, count=1)


def test_a_photo_without_caps_teaches_that_nothing_is_there(examples: list[Example]) -> None:
    bare = Example(path=examples[1].path, width=96, height=64, caps=[])
    settings = SampleConfig(crop=STILL, network=TINY, batch=2, soft=True, seed=0)
    seen = Batches([bare, examples[0]], settings, count=1)[0]
    empty = seen.counts.index(0)
    assert all((cells[empty] == EMPTY).all() for cells in seen.cells)


def test_outside_the_caps_of_a_photo_labelled_in_part_nothing_is_learnt(examples: list[Example]) -> None:
    one = examples[0]
    example = Example(path=one.path, width=96, height=64, caps=one.caps[:1], complete=False)
    settings = SampleConfig(crop=STILL, network=TINY, batch=4, soft=True, seed=0)
    batch = Batches([example], settings, count=1)[0]
    for nth, caps in enumerate(batch.caps):
        inside = caps.masks[0].bool()
        assert torch.equal(caps.ignored, ~inside)
        for level in batch.cells:
            cells = level[nth]
            rows, columns = cells.shape
            middles = [
                ((r + 0.5) * 64 / rows, (c + 0.5) * 64 / columns) for r in range(rows) for c in range(columns)
            ]
            within = torch.tensor([bool(inside[int(y), int(x)]) for y, x in middles]).view(rows, columns)
            assert (cells[~within] != EMPTY).all()
            assert (cells[within] != IGNORED).all()


def test_a_photo_that_cannot_be_read_is_named(tmp_path: Path, examples: list[Example]) -> None:
    lost = Example(path=tmp_path / "lost.png", width=96, height=64, caps=examples[0].caps)
    with pytest.raises(PhotoError, match=r"lost\.png"):
        _ = Batches([lost], SETTINGS, count=1)[0]


def test_a_batch_moves_to_a_device_as_a_whole(examples: list[Example]) -> None:
    batch = Batches(examples, SETTINGS, count=1)[0]
    moved = batch.to(torch.device("meta"))
    assert all(part.is_meta for part in tensors(moved))
