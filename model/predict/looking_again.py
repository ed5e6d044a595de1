"""What was found in a photo, cut out as the network's second look takes it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import cv2
import numpy as np
import torch
from numpy.typing import NDArray

from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.model.geometry.raster import box_of_mask
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.network.second_look import LAYERS, SIDE, Said, Windows
from fairyring.model.photo import Pixels
from fairyring.model.predict.overlaps import Window
from fairyring.model.predict.pooling import Found
from fairyring.model.predict.seen import SeenPiece

Kind = TypeVar("Kind", np.uint8, np.int32)
AGREED = 0.35
"""How much weight the agreement of two passes has in the expected IoU: they differ where neither is sure."""


@dataclass(frozen=True, kw_only=True)
class Opinion:
    """What the second look says of a cap."""

    quality: float
    """Expected IoU of its mask, 0 to 1."""
    whole: LikelyEllipse
    """The whole ellipse; pixels of the scaled photo."""


@dataclass(frozen=True, kw_only=True)
class Cut:
    """n ≥ 0 caps cut out of a scaled photo."""

    layers: NDArray[np.float32]
    """(n, LAYERS, SIDE, SIDE), as `Windows` has them."""
    places: NDArray[np.float32]
    """(n, 3): x and y of the middle, and half the width of each window; pixels of the scaled photo."""


def opinions_of(
    network: PRSOLOv2, photo: Pixels, pieces: Sequence[SeenPiece], found: Sequence[Found]
) -> list[Opinion] | None:
    """What the second look says of each cap; None where the network has none.

    ``photo`` is the scaled one; the caps' masks must not be empty.
    """
    look = network.second_look
    if look is None or any(piece.outputs.point_maps is None for piece in pieces):
        return None
    cut = cut_out(photo, [one.window for one in found])
    opinions: dict[int, Opinion] = {}
    for nth, piece in enumerate(pieces):
        chosen = [index for index, one in enumerate(found) if one.piece == nth]
        if chosen and piece.outputs.point_maps is not None:
            windows = windows_in(piece, cut, found, chosen)
            said = look(piece.outputs.point_maps, windows)
            opinions |= zip(chosen, _opinions(network, said, cut.places[chosen]), strict=True)
    return [agreed(opinions[index], one.agreement) for index, one in enumerate(found)]


def agreed(opinion: Opinion, agreement: float | None) -> Opinion:
    """With a quality that counts how well the passes agree which saw the cap."""
    if agreement is None:
        return opinion
    return replace(opinion, quality=(1 - AGREED) * opinion.quality + AGREED * agreement)


def windows_in(piece: SeenPiece, cut: Cut, found: Sequence[Found], chosen: Sequence[int]) -> Windows:
    """The chosen caps, n ≥ 1 and all of one piece, as the network takes them."""
    device = piece.outputs.feature.device
    places = cut.places[chosen] * np.float32(piece.seen_in.enlarged)
    places[:, :2] -= (piece.tile.x, piece.tile.y)
    return Windows(
        layers=torch.from_numpy(cut.layers[chosen]).to(device),
        places=torch.from_numpy(places).to(device),
        owners=torch.full((len(chosen),), piece.index, device=device),
        kernels=torch.stack([found[index].kernel for index in chosen]),
        scores=torch.tensor([found[index].score for index in chosen], device=device),
    )


def cut_out(photo: Pixels, windows: Sequence[Window]) -> Cut:
    """Cuts caps out of a photo (height, width, 3) that all these caps lie in; no mask is empty."""
    height, width = photo.shape[:2]
    owner = np.zeros((height, width), np.int32)
    for nth, window in enumerate(windows, 1):
        rows, columns = window.logits.shape
        here = np.s_[window.y : window.y + rows, window.x : window.x + columns]
        owner[here][window.logits > 0] = nth
    places = np.array([_place_of(window) for window in windows], np.float32).reshape(-1, 3)
    layers = np.zeros((len(windows), LAYERS, SIDE, SIDE), np.float32)
    for nth, (window, place) in enumerate(zip(windows, places, strict=True)):
        left, top, half = int(place[0] - place[2]), int(place[1] - place[2]), int(place[2])
        there = _square(owner, left, top, 2 * half)
        logits = np.full((2 * half, 2 * half), -20, np.float32)
        _paste(logits, window, left, top)
        others = ((there > 0) & (there != nth + 1)).astype(np.float32)
        own = 1 / (1 + np.exp(-logits.clip(-20, 20)))
        pixels = _square(photo, left, top, 2 * half)
        seen = cv2.resize(pixels, (SIDE, SIDE), interpolation=cv2.INTER_AREA)
        layers[nth, :3] = np.asarray(seen).transpose(2, 0, 1) / np.float32(127.5) - 1
        for layer, values in ((3, own), (4, others)):
            layers[nth, layer] = cv2.resize(values, (SIDE, SIDE), interpolation=cv2.INTER_AREA)
    return Cut(layers=layers, places=places)


def _place_of(window: Window) -> tuple[float, float, float]:
    """Middle and half width of the window that a cap is looked at in, such that it begins at a pixel."""
    rows, columns = box_of_mask(window.logits > 0)
    half = max(columns.stop - columns.start, rows.stop - rows.start)
    x, y = (columns.start + columns.stop) // 2, (rows.start + rows.stop) // 2
    return float(window.x + x), float(window.y + y), float(half)


def _square(canvas: NDArray[Kind], left: int, top: int, side: int) -> NDArray[Kind]:
    """A square of a canvas (height, width, …), zero where it lies outside."""
    height, width = canvas.shape[:2]
    square = np.zeros((side, side, *canvas.shape[2:]), canvas.dtype)
    first_row, last_row = max(top, 0), min(top + side, height)
    first, last = max(left, 0), min(left + side, width)
    if first_row < last_row and first < last:
        square[first_row - top : last_row - top, first - left : last - left] = canvas[
            first_row:last_row, first:last
        ]
    return square


def _paste(square: NDArray[np.float32], window: Window, left: int, top: int) -> None:
    """Puts a window's logits into a square whose first pixel is column ``left``, row ``top``."""
    side = len(square)
    rows, columns = window.logits.shape
    x, y = window.x - left, window.y - top
    first_row, last_row, first, last = max(y, 0), min(y + rows, side), max(x, 0), min(x + columns, side)
    if first_row < last_row and first < last:
        square[first_row:last_row, first:last] = window.logits[
            first_row - y : last_row - y, first - x : last - x
        ]


def _opinions(network: PRSOLOv2, said: Said, places: NDArray[np.float32]) -> Iterator[Opinion]:
    """In pixels of the scaled photo, whose windows (n, 3) are given."""
    look = network.second_look
    assert look is not None
    qualities = look.calibrated_quality(said).tolist()
    means = said.mean.double().cpu().numpy()
    covariances = look.calibrated_covariance(said).double().cpu().numpy()
    for quality, mean, covariance, (x, y, half) in zip(
        qualities, means.tolist(), covariances, places.astype(np.float64).tolist(), strict=True
    ):
        dx, dy, log_r, u, v = mean
        # The centre is known in half windows, and its spread wanted in radii.
        to_radii = np.array([math.exp(-log_r)] * 2 + [1.0, 1.0, 1.0])
        whole = LikelyEllipse(
            parameters=(x + half * dx, y + half * dy, log_r + math.log(half / 2), u, v),
            covariance=tuple(map(tuple, (covariance * to_radii * to_radii[:, None]).tolist())),
        )
        yield Opinion(quality=quality, whole=whole)
