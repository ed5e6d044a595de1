"""From photos to the caps in them: some passes, then as many readings as are wanted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np
import torch
from msgspec import Struct, field, structs
from numpy.typing import NDArray

from fairyring.model.geometry.boxes import Box
from fairyring.model.geometry.raster import rle_of_outline
from fairyring.model.geometry.shapes import Outline, points_of_part
from fairyring.model.network.decode import DecodeConfig, Instances, decode
from fairyring.model.network.fold import fold_batch_norms
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.network.refine import refine
from fairyring.model.photo import Pixels
from fairyring.model.predict.added_and_taken import behind, parted
from fairyring.model.predict.calibration import Calibration, calibrated, uncalibrated
from fairyring.model.predict.level_lines import outline_of_logits
from fairyring.model.predict.looking_again import Opinion, opinions_of
from fairyring.model.predict.overlaps import Window, distinct
from fairyring.model.predict.passes import ONE_PASS, Pass, resized
from fairyring.model.predict.pooling import Found, Piece, pooled
from fairyring.model.predict.prompts import Pointed, cap_at, cap_in
from fairyring.model.predict.seen import Detection, Seen, SeenPiece
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
        self.rim = float(network.rim)

    def detect(self, photo: Pixels, *, scale: float = 1.0) -> list[Detection]:
        """``see`` and ``read`` of one photo."""
        return self.read(self.see(photo, scale=scale))

    def see(self, photo: Pixels, *, scale: float = 1.0) -> Seen:
        """Runs the network on a photo (height, width, 3) uint8 RGB, brought to a scale; for ``read``."""
        scaled = resized(photo, scale)
        pieces = [piece for nth in self.settings.passes for piece in self.go_over(scaled, nth)]
        return Seen(
            width=photo.shape[1],
            height=photo.shape[0],
            photo=scaled,
            pieces=pieces,
        )

    @torch.inference_mode()
    def go_over(self, scaled: Pixels, nth: Pass) -> list[SeenPiece]:
        """One pass of the network over a scaled photo (height, width, 3) uint8 RGB."""
        pieces = []
        photo = resized(scaled, nth.enlarged)
        tiles = tiles_of(photo.shape[1], photo.shape[0], overlap=nth.overlap)
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
            pieces.append(
                Piece(
                    seen_in=piece.seen_in,
                    tile=piece.tile,
                    scores=scores,
                    windows=windows,
                    kernels=instances.kernels,
                )
            )
        return pieces

    @torch.inference_mode()
    def instances(self, piece: SeenPiece, settings: DecodeConfig) -> Instances:
        """The instances of a piece without duplicates, not refined yet."""
        found = decode(piece.outputs, piece.index, self.network.config, settings)
        return _chosen(found, distinct((found.logits > 0).cpu().numpy(), found.scores.tolist()))

    def pool(self, seen: Seen, pieces: Sequence[Piece]) -> list[Found]:
        """The caps of all pieces with smooth masks, none of them empty, in falling order of raw score."""
        width, height = seen.scaled
        smooth = [
            replace(one, window=replace(one.window, logits=smoothed(one.window.logits)))
            for one in pooled(pieces, width=width, height=height, rim=self.rim)
        ]
        return [one for one in smooth if (one.window.logits > 0).any()]

    @torch.inference_mode()
    def tell(self, seen: Seen, pieces: Sequence[Piece]) -> list[Detection]:
        """Pools the pieces, looks at each cap once more and traces outlines; the second half of ``read``."""
        found = self.pool(seen, pieces)
        opinions = opinions_of(self.network, seen.photo, seen.pieces, found) or [None] * len(found)
        raw = [one.score * (said.quality if said else 1) for one, said in zip(found, opinions, strict=True)]
        scores = calibrated(np.array(raw), self.calibration).tolist()
        told = [
            self._detection(seen, score, one.window, said)
            for score, one, said in zip(scores, found, opinions, strict=True)
            if score >= self.settings.least_score
        ]
        return sorted([one for one in told if one is not None], key=lambda one: -one.score)

    def _detection(self, seen: Seen, score: float, window: Window, said: Opinion | None) -> Detection | None:
        """A cap of the scaled photo in the pixels of the photo; None where its mask is no outline."""
        outline = outline_of_logits(window.logits, corner=(window.x, window.y))
        if not outline:
            return None
        scaling = _scaling(seen)
        outline = _scaled(outline, 1 / scaling)
        return Detection(
            score=score,
            outline=outline,
            rle=rle_of_outline(outline, height=seen.height, width=seen.width),
            quality=said.quality if said else None,
            whole=said.whole.enlarged(1 / scaling) if said else None,
        )

    @torch.inference_mode()
    def at(
        self,
        seen: Seen,
        points: Sequence[tuple[float, float]],
        labels: Sequence[bool] = (True,),
        *,
        front: Sequence[Outline] = (),
    ) -> Detection | None:
        """The cap at clicks x, y in the photo that was seen; None where the network sees none.

        ``labels``: whether a point is to be on it; the first must be. ``front``: outlines of caps of which
        it may show no pixel; those that hold a point that is to be on it do not count. Where they leave
        of a cap only what lies beside these points, nobody pointed at it.
        """
        places, wanted = np.array(points, np.float64).reshape(-1, 2), np.array(labels, np.bool_)
        if len(places) != len(wanted) or not wanted[:1].all() or not len(places):
            raise ValueError("Every point needs a label, and the first must be on the cap.")
        scaling = _scaling(seen)
        found = self._drawn(cap_at(self.network, seen, places * scaling, wanted, finest=self.settings.finest))
        for taken in places[~wanted] * scaling:
            # A notch that goes no further than the click is smoothed away again.
            if found is not None and _holds(_smooth_outline(found.window), taken):
                found = replace(found, window=parted(found.window, places[wanted] * scaling, taken))
        others = [o for o in front if not any(_holds(o, place) for place in places[wanted])]
        told = self._told(seen, found, others)
        if told is None or (others and not any(_holds(told.outline, place) for place in places[wanted])):
            return None
        return told

    @torch.inference_mode()
    def within(self, seen: Seen, box: Box, *, front: Sequence[Outline] = ()) -> Detection | None:
        """The cap whose box is most like this one, left, top, right, bottom in the photo; else as ``at``."""
        left, top, right, bottom = (np.array(box) * np.tile(_scaling(seen), 2)).tolist()
        if not (left < right and top < bottom):
            raise ValueError("A box is given by its left, top, right and bottom.")
        found = cap_in(self.network, seen, (left, top, right, bottom), finest=self.settings.finest)
        return self._told(seen, self._drawn(found), front)

    def _drawn(self, pointed: Pointed | None) -> Pointed | None:
        """The cap with its rim where people draw it."""
        if pointed is None:
            return None
        logits = pointed.window.logits + np.float32(self.rim)
        return replace(pointed, window=replace(pointed.window, logits=logits))

    def _told(self, seen: Seen, pointed: Pointed | None, front: Sequence[Outline]) -> Detection | None:
        """The one cap that was asked for, cut where others lie in front; None where nothing is left of it."""
        if pointed is None:
            return None
        window = behind(pointed.window, [_scaled(outline, _scaling(seen)) for outline in front])
        window = replace(window, logits=smoothed(window.logits))
        if not (window.logits > 0).any():
            return None
        found = Found(score=pointed.score, window=window, piece=0, kernel=pointed.kernel)
        opinions = opinions_of(self.network, seen.photo, [pointed.piece], [found])
        said = opinions[0] if opinions else None
        raw = pointed.score * (said.quality if said else 1)
        return self._detection(seen, float(calibrated(np.array(raw), self.calibration)), window, said)

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


def _scaling(seen: Seen) -> NDArray[np.float64]:
    """Pixels of the scaled photo for each pixel of the photo, along x and y."""
    return np.array(seen.scaled) / (seen.width, seen.height)


def _smooth_outline(window: Window) -> Outline:
    return outline_of_logits(smoothed(window.logits), corner=(window.x, window.y))


def _holds(outline: Outline, point: NDArray[np.float64]) -> bool:
    x, y = point.tolist()
    parts = (points_of_part(part).astype(np.float32) for part in outline)
    return any(cv2.pointPolygonTest(part[:, None], (x, y), False) >= 0 for part in parts)


def _scaled(outline: Outline, by: NDArray[np.float64]) -> Outline:
    if (by == 1).all():
        return outline
    return [(np.reshape(part, (-1, 2)) * by).ravel().tolist() for part in outline]
