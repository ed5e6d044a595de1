"""From photos to the caps in them: one forward pass a photo, then as many readings as are wanted."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import torch
from msgspec import Struct, field, structs
from numpy.typing import NDArray

from fairyring.model.geometry.raster import Rle, iou_matrix, rle_of_outline
from fairyring.model.geometry.shapes import Outline
from fairyring.model.network.decode import DecodeConfig, Instances, decode
from fairyring.model.network.fold import fold_batch_norms
from fairyring.model.network.pr_solov2 import Outputs, PRSOLOv2
from fairyring.model.network.refine import refine
from fairyring.model.predict.calibration import Calibration, calibrated, uncalibrated
from fairyring.model.predict.level_lines import outline_of_logits
from fairyring.model.predict.overlaps import Window, distinct, resolve_overlaps
from fairyring.model.predict.tiles import Tile, tiles_of

SLACK = 8.0
"""By how many pixels two pieces may differ about the middle of a cap at their seam."""
SAME = 0.5
"""Least IoU of two pieces' detections of the same cap."""


class PredictConfig(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Settings of a predictor."""

    decode: DecodeConfig = field(default_factory=DecodeConfig)
    least_score: float = 0.0
    """Least calibrated score of a detection that is returned."""
    finest: int = 2
    """Photo pixels a side of the finest points that PointRend decides on: 1, 2, 4 …"""
    batch: int = 1
    """How many pieces of one size go through the network together."""


@dataclass(frozen=True, kw_only=True)
class Detection:
    """One cap as the network sees it."""

    score: float
    """Probability that this is a cap and the outline its own, 0 to 1."""
    outline: Outline
    """Outline of what is visible, with sub-pixel edges."""
    rle: Rle
    """The pixels of the outline."""


@dataclass(frozen=True, kw_only=True)
class Seen:
    """A photo that went through the network."""

    width: int
    height: int
    pieces: list[tuple[Tile, Outputs, int]]
    """Each piece of the photo, the network's outputs for its batch, and the piece's index in that batch."""


@dataclass(frozen=True, kw_only=True)
class Piece:
    """The instances of a piece of a photo, refined to photo pixels."""

    tile: Tile
    scores: list[float]
    """Raw scores, in falling order."""
    windows: list[Window]


class Predictor:
    """A network made ready for photos on one device."""

    def __init__(
        self, network: PRSOLOv2, *, device: torch.device, settings: PredictConfig | None = None
    ) -> None:
        """Takes the network over: its batch norms are folded, and it is moved to the device."""
        fold_batch_norms(network.eval())
        self.network = network.to(device=device, memory_format=torch.channels_last)  # pyright: ignore
        self.device = device
        self.settings = settings or PredictConfig()
        self.calibration = Calibration(*network.calibration.tolist())

    @torch.inference_mode()
    def see(self, photos: Sequence[NDArray[np.uint8]]) -> list[Seen]:
        """Runs the network on photos (height, width, 3) uint8 RGB; its outputs for each are for ``read``."""
        seen = [Seen(width=photo.shape[1], height=photo.shape[0], pieces=[]) for photo in photos]
        by_shape: dict[tuple[int, int], list[tuple[int, Tile]]] = {}
        for nth, photo in enumerate(photos):
            for tile in tiles_of(photo.shape[1], photo.shape[0]):
                by_shape.setdefault(self._padded(tile), []).append((nth, tile))
        for shape, jobs in by_shape.items():
            for first in range(0, len(jobs), self.settings.batch):
                batch = jobs[first : first + self.settings.batch]
                inputs = np.zeros((len(batch), *shape, 3), np.uint8)
                for index, (nth, tile) in enumerate(batch):
                    inputs[index, : tile.height, : tile.width] = photos[nth][
                        tile.y : tile.y + tile.height, tile.x : tile.x + tile.width
                    ]
                origins = torch.tensor([(-tile.width / 2, -tile.height / 2) for _, tile in batch])
                pixels = torch.from_numpy(inputs).to(self.device).permute(0, 3, 1, 2)
                outputs = self.network(pixels, origins.to(self.device))
                for index, (nth, tile) in enumerate(batch):
                    seen[nth].pieces.append((tile, outputs, index))
        return seen

    def read(self, seen: Seen, settings: DecodeConfig | None = None) -> list[Detection]:
        """The caps of a photo, in falling order of score."""
        return self.tell(seen, self.refine(seen, settings))

    @torch.inference_mode()
    def refine(self, seen: Seen, settings: DecodeConfig | None = None) -> list[Piece]:
        """The instances of each piece of a photo; the first half of ``read``."""
        settings = settings or self.settings.decode
        least = max(settings.least_score, uncalibrated(self.settings.least_score, self.calibration))
        settings = structs.replace(settings, least_score=least)
        config = self.network.config
        pieces = []
        for tile, outputs, index in seen.pieces:
            instances = _distinct(decode(outputs, index, config, settings))
            refined = refine(
                self.network.point_head,
                outputs.point_maps,
                instances,
                image=index,
                mask_stride=config.mask_stride,
                finest=self.settings.finest,
            )
            windows = [Window(x=x, y=y, logits=logits.float().cpu().numpy()) for x, y, logits in refined]
            pieces.append(Piece(tile=tile, scores=instances.scores.tolist(), windows=windows))
        return pieces

    def tell(self, seen: Seen, pieces: Sequence[Piece]) -> list[Detection]:
        """Resolves overlaps and traces outlines; the second half of ``read``."""
        found = [
            (detection, nth)
            for nth, piece in enumerate(pieces)
            for detection in _outlined(piece, width=seen.width, height=seen.height)
        ]
        found.sort(key=lambda one: -one[0].score)
        kept = _without_repeats(found) if len(pieces) > 1 else [detection for detection, _ in found]
        scores = calibrated(np.array([detection.score for detection in kept]), self.calibration)
        return [replace(one, score=score) for one, score in zip(kept, scores.tolist(), strict=True)]

    def detect(self, photo: NDArray[np.uint8]) -> list[Detection]:
        """``see`` and ``read`` of one photo."""
        return self.read(self.see([photo])[0])

    def _padded(self, tile: Tile) -> tuple[int, int]:
        multiple = self.network.config.multiple
        return -(-tile.height // multiple) * multiple, -(-tile.width // multiple) * multiple


def _outlined(piece: Piece, *, width: int, height: int) -> Iterator[Detection]:
    """The detections of a piece of a photo of this size, with raw scores."""
    tile = piece.tile
    resolved = resolve_overlaps(piece.windows, piece.scores, width=tile.width, height=tile.height)
    for score, window in zip(piece.scores, resolved, strict=True):
        outline = outline_of_logits(window.logits, corner=(window.x + tile.x, window.y + tile.y))
        if not outline:
            continue
        points = np.concatenate([np.reshape(part, (-1, 2)) for part in outline])
        if tile.owns(*((points.min(axis=0) + points.max(axis=0)) / 2).tolist(), slack=SLACK):
            rle = rle_of_outline(outline, height=height, width=width)
            yield Detection(score=score, outline=outline, rle=rle)


def _distinct(instances: Instances) -> Instances:
    """The instances without duplicates, which need not be refined."""
    kept = distinct((instances.logits > 0).cpu().numpy(), instances.scores.tolist())
    chosen = torch.tensor(kept, dtype=torch.int64, device=instances.scores.device)
    return Instances(*(part[chosen] for part in instances))


def _without_repeats(found: list[tuple[Detection, int]]) -> list[Detection]:
    """Drops detections that another piece has with a better score; given with their piece, scores falling."""
    rles = [detection.rle for detection, _ in found]
    overlaps, pieces = iou_matrix(rles, rles), np.array([piece for _, piece in found])
    kept: list[int] = []
    for nth in range(len(found)):
        repeats = (overlaps[nth, kept] >= SAME) & (pieces[kept] != pieces[nth])
        if not repeats.any():
            kept.append(nth)
    return [found[nth][0] for nth in kept]
