"""Training data: labelled photos, and batches of crops from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import numpy as np
import torch
from msgspec import Struct
from torch.utils.data import Dataset

from fairyring.model import photo
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.shapes import Outline, Shape
from fairyring.model.network.config import NetworkConfig
from fairyring.model.network.objective import Batch
from fairyring.model.network.targets import assign_cells
from fairyring.model.train.augment import sample_augmentation
from fairyring.model.train.crops import Crop, CropConfig, cut_crop

CACHED_PHOTOS = 700
"""How many decoded photos are kept in memory: about 2 GB at 1280 × 720."""


class DataError(FairyringError):
    """Labels that nothing can be learnt from."""


@dataclass(frozen=True, kw_only=True)
class Example:
    """One labelled photo."""

    path: Path
    width: int
    """Width of the upright photo, pixels."""
    height: int
    caps: list[Outline]
    """Visible outlines of the caps to learn."""
    ignored: list[Outline] = field(default_factory=list)
    """Outlines of regions where nothing is learnt."""
    wholes: list[Shape | None] = field(default_factory=list)
    """The whole outline of each cap where it is known; empty where none is."""
    complete: bool = True
    """Whether these are all caps of the photo; else nothing is learnt outside them."""
    light: str | None = None
    form: str | None = None
    sha256: str = ""
    """Of the photo's file: copies of it are one photo. Empty where it is not known."""


class SampleConfig(Struct, frozen=True, kw_only=True):
    """How batches are sampled."""

    crop: CropConfig
    network: NetworkConfig
    batch: int
    soft: bool
    """Whether targets are the share of each cell that the cap covers; else 1 where it covers half of it."""
    seed: int


class Batches(Dataset[Batch]):
    """Batches by number: the same examples, settings and number always give the same one."""

    def __init__(self, examples: Sequence[Example], settings: SampleConfig, *, count: int) -> None:
        if not any(example.caps for example in examples):
            raise DataError("No cap is labelled in these images; label some, or give another file.")
        self.examples = list(examples)
        self.settings, self.count = settings, count

    def __len__(self) -> int:
        return self.count

    def __getitem__(self, iteration: int) -> Batch:
        settings = self.settings
        crops = []
        for nth in range(settings.batch):
            rng = np.random.default_rng([settings.seed, iteration, nth])
            example = self.examples[self._turn(iteration * settings.batch + nth)]
            crops.append(
                cut_crop(
                    read_rgb(example.path),
                    example.caps,
                    example.ignored,
                    wholes=example.wholes,
                    complete=example.complete,
                    augmentation=sample_augmentation(
                        rng,
                        most_rotation_deg=settings.crop.most_rotation_deg,
                        most_brightness=settings.crop.most_brightness,
                    ),
                    config=settings.crop,
                    rng=rng,
                )
            )
        return batch_of(crops, settings.network, soft=settings.soft)

    def _turn(self, taken: int) -> int:
        """Which example is next: each once a round, in a random order of the round's own."""
        count = len(self.examples)
        rng = np.random.default_rng([self.settings.seed, taken // count, 1 << 20])
        return int(rng.permutation(count)[taken % count])


def batch_of(crops: Sequence[Crop], network: NetworkConfig, *, soft: bool) -> Batch:
    """Puts crops of one size together into a batch."""
    masks = torch.from_numpy(np.concatenate([crop.masks for crop in crops]))
    targets = torch.nn.functional.avg_pool2d(masks[:, None].float(), network.mask_stride)[:, 0]
    return Batch(
        photos=torch.from_numpy(np.stack([crop.photo for crop in crops]).transpose(0, 3, 1, 2)),
        origins=torch.tensor([crop.origin for crop in crops], dtype=torch.float32),
        counts=[len(crop.masks) for crop in crops],
        masks=masks,
        targets=targets if soft else _binary(targets),
        cells=_cells_of(crops, network),
        ignored=torch.from_numpy(np.stack([crop.ignored for crop in crops])),
        wholes=torch.from_numpy(np.concatenate([crop.wholes for crop in crops])),
    )


def _cells_of(crops: Sequence[Crop], network: NetworkConfig) -> list[torch.Tensor]:
    """Each level's cells of all crops, the caps counted on from crop to crop."""
    each, first = [], 0
    for crop in crops:
        height, width = crop.photo.shape[:2]
        levels = assign_cells(
            crop.boxes, crop.centres, network, height=height, width=width, ignored=crop.ignored
        )
        each.append([np.where(cells >= 0, cells + first, cells) for cells in levels])
        first += len(crop.masks)
    return [torch.from_numpy(np.stack(level)) for level in zip(*each, strict=True)]


def _binary(targets: torch.Tensor) -> torch.Tensor:
    """(n, h, w) shares → 1 where half of a cell is cap; the fullest cells where none is half full."""
    return (targets >= targets.amax((1, 2), keepdim=True).clamp(max=0.5)).float()


@lru_cache(maxsize=CACHED_PHOTOS)
def read_rgb(path: Path) -> photo.Pixels:
    """Reads a photo as (height, width, 3) uint8, RGB, upright. Raises PhotoError."""
    return np.ascontiguousarray(photo.read(path)[:, :, ::-1])
