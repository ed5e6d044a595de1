"""From photos to the caps in them: some passes, then as many readings as are wanted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import torch
from msgspec import Struct, field, structs
from numpy.typing import NDArray

from fairyring.model.geometry.raster import Rle, rle_of_outline
from fairyring.model.geometry.shapes import Outline
from fairyring.model.network.decode import DecodeConfig, Instances, decode
from fairyring.model.network.fold import fold_batch_norms
from fairyring.model.network.pr_solov2 import Outputs, PRSOLOv2
from fairyring.model.network.refine import refine
from fairyring.model.photo import Pixels
from fairyring.model.predict.calibration import Calibration, calibrated, uncalibrated
from fairyring.model.predict.level_lines import outline_of_logits
from fairyring.model.predict.overlaps import Window, distinct
from fairyring.model.predict.passes import ONE_PASS, Pass, resized
from fairyring.model.predict.pooling import Piece, pooled
from fairyring.model.predict.smoothing import smoothed
from fairyring.model.predict.tiles import Tile, tiles_of

ABOUT = 1.4
"""A cap's diameter may change by so much when its mask is refined."""


class PredictConfig(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Settings of a predictor."""

    decode: DecodeConfig = field(default_factory=DecodeConfig)
    least_score: float = 0.0
    """Least calibrated score of a detection that is returned."""
    finest: int = 2
    """Pixels a side, as a pass is given them, of the finest points that PointRend decides on: 1, 2, 4 …"""
    batch: int = 1
    """How many pieces of one size go through the network together."""
    passes: tuple[Pass, ...] = ONE_PASS


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
class SeenPiece:
    """A piece of a photo in one pass, and the network's outputs for it."""

    seen_in: Pass
    tile: Tile
    outputs: Outputs
    """For the batch that the piece was in."""
    index: int
    """Of the piece in that batch."""


@dataclass(frozen=True, kw_only=True)
class Seen:
    """A photo that went through the network."""

    width: int
    height: int
    scaled: tuple[int, int]
    """Width and height of the scaled photo."""
    pieces: list[SeenPiece]


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

    def detect(self, photo: Pixels, *, scale: float = 1.0) -> list[Detection]:
        """``see`` and ``read`` of one photo."""
        return self.read(self.see(photo, scale=scale))

    def see(self, photo: Pixels, *, scale: float = 1.0, seen: Sequence[SeenPiece] = ()) -> Seen:
        """Runs the network on a photo (height, width, 3) uint8 RGB, brought to a scale; for ``read``.

        ``seen``: what a pass over the photo at this scale, not enlarged, gave already.
        """
        scaled = resized(photo, scale)
        pieces: list[SeenPiece] = []
        for nth in self.settings.passes:
            again = seen if seen and nth.enlarged == 1 else self.go_over(scaled, nth)
            pieces += [replace(piece, seen_in=nth) for piece in again]
        return Seen(
            width=photo.shape[1],
            height=photo.shape[0],
            scaled=(scaled.shape[1], scaled.shape[0]),
            pieces=pieces,
        )

    @torch.inference_mode()
    def go_over(self, scaled: Pixels, nth: Pass) -> list[SeenPiece]:
        """One pass of the network over a scaled photo (height, width, 3) uint8 RGB."""
        pieces = []
        photo = resized(scaled, nth.enlarged)
        tiles = tiles_of(photo.shape[1], photo.shape[0])
        for first in range(0, len(tiles), self.settings.batch):
            batch = tiles[first : first + self.settings.batch]
            inputs = np.zeros((len(batch), *self._padded(batch[0]), 3), np.uint8)
            for index, tile in enumerate(batch):
                inputs[index, : tile.height, : tile.width] = photo[
                    tile.y : tile.y + tile.height, tile.x : tile.x + tile.width
                ]
            origins = torch.tensor([(-tile.width / 2, -tile.height / 2) for tile in batch])
            pixels = torch.from_numpy(inputs).to(self.device).permute(0, 3, 1, 2)
            outputs = self.network(pixels, origins.to(self.device))
            for index, tile in enumerate(batch):
                pieces.append(SeenPiece(seen_in=nth, tile=tile, outputs=outputs, index=index))
        return pieces

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
        for piece in seen.pieces:
            instances = self.instances(piece, settings)
            instances = _of_size(instances, piece.seen_in, stride=config.mask_stride)
            refined = refine(
                self.network.point_head,
                piece.outputs.point_maps,
                instances,
                image=piece.index,
                mask_stride=config.mask_stride,
                finest=self.settings.finest,
            )
            windows = [Window(x=x, y=y, logits=logits.float().cpu().numpy()) for x, y, logits in refined]
            scores = instances.scores.tolist()
            pieces.append(Piece(seen_in=piece.seen_in, tile=piece.tile, scores=scores, windows=windows))
        return pieces

    @torch.inference_mode()
    def instances(self, piece: SeenPiece, settings: DecodeConfig) -> Instances:
        """The instances of a piece without duplicates, not refined yet."""
        found = decode(piece.outputs, piece.index, self.network.config, settings)
        return _chosen(found, distinct((found.logits > 0).cpu().numpy(), found.scores.tolist()))

    def tell(self, seen: Seen, pieces: Sequence[Piece]) -> list[Detection]:
        """Pools the pieces and traces outlines; the second half of ``read``."""
        width, height = seen.scaled
        photo_pixels = np.array([seen.width / width, seen.height / height])
        found = [
            (score, _scaled(outline, photo_pixels))
            for score, window in pooled(pieces, width=width, height=height)
            if (outline := outline_of_logits(smoothed(window.logits), corner=(window.x, window.y)))
        ]
        scores = calibrated(np.array([score for score, _ in found]), self.calibration)
        return [
            Detection(
                score=score,
                outline=outline,
                rle=rle_of_outline(outline, height=seen.height, width=seen.width),
            )
            for score, (_, outline) in zip(scores.tolist(), found, strict=True)
        ]

    def _padded(self, tile: Tile) -> tuple[int, int]:
        multiple = self.network.config.multiple
        return -(-tile.height // multiple) * multiple, -(-tile.width // multiple) * multiple


def _of_size(instances: Instances, nth: Pass, *, stride: int) -> Instances:
    """The instances that may be of the sizes that a pass is for; the others need not be refined."""
    pixels = ((instances.logits > 0).sum((1, 2)) * stride**2).tolist()
    return _chosen(instances, [index for index, count in enumerate(pixels) if nth.takes(count, slack=ABOUT)])


def _chosen(instances: Instances, kept: Sequence[int]) -> Instances:
    chosen = torch.tensor(kept, dtype=torch.int64, device=instances.scores.device)
    return Instances(*(part[chosen] for part in instances))


def _scaled(outline: Outline, by: NDArray[np.float64]) -> Outline:
    if (by == 1).all():
        return outline
    return [(np.reshape(part, (-1, 2)) * by).ravel().tolist() for part in outline]
