"""The cap that a person points at: at clicks, or in a box, in a photo that went through the network.

The surest mask among those of the grid cells at the clicks is taken; further clicks choose another one, add
what is seen at them, or take it away. PointRend draws the edge.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from fairyring.model.geometry.boxes import Box
from fairyring.model.geometry.shapes import Points
from fairyring.model.network.boxes import boxes_of
from fairyring.model.network.decode import Instances
from fairyring.model.network.pr_solov2 import PRSOLOv2
from fairyring.model.network.refine import refine
from fairyring.model.predict.added_and_taken import joined, parted, value_at, without
from fairyring.model.predict.candidates import Candidates, candidates_at, logits_at
from fairyring.model.predict.overlaps import Window, cut
from fairyring.model.predict.passes import shrunk
from fairyring.model.predict.seen import Seen, SeenPiece

ABOUT = 1.4
"""A mask may be so many times wider or narrower than the caps that a pass is for."""

Rating = Callable[[Candidates, SeenPiece], Tensor]
"""(n,) how well each mask fits what was asked for; the largest is taken, and none that is not above 0."""


@dataclass(frozen=True)
class _Chosen:
    """A mask among the candidates of a piece."""

    piece: SeenPiece
    rating: float
    score: float
    """Raw."""
    kernel: Tensor
    logits: Tensor
    """(h, w), at the mask stride."""


@dataclass(frozen=True, kw_only=True)
class Pointed:
    """The cap that was asked for, in the scaled photo."""

    score: float
    """Raw."""
    window: Window
    kernel: Tensor
    """(E,)."""
    piece: SeenPiece
    """The piece that it was seen in."""


def cap_at(
    network: PRSOLOv2, seen: Seen, points: Points, labels: NDArray[np.bool_], *, finest: int
) -> Pointed | None:
    """The cap at clicks (p, 2), x, y in the scaled photo.

    ``labels`` (p,): whether the cap is to be there, or not; one at least is. None where nothing is seen.
    """
    best = _best_at(network, seen, points, labels)
    if best is None:
        return None
    window = _drawn(network, seen, best, finest=finest)
    for point in points[labels]:
        if value_at(window, point) <= 0:
            alone = np.concatenate([point[None], points[~labels]])
            more = _best_at(network, seen, alone, np.arange(len(alone)) == 0)
            if more is not None:
                window = joined(window, _drawn(network, seen, more, finest=finest))
    for point in points[~labels]:
        if value_at(window, point) > 0:
            there = np.concatenate([point[None], points[labels]])
            less = _best_at(network, seen, there, np.arange(len(there)) == 0, all_of_them=True)
            if less is not None:
                window = without(window, _drawn(network, seen, less, finest=finest))
            if value_at(window, point) > 0:
                window = parted(window, points[labels], point)
    return _pointed(best, window)


def cap_in(network: PRSOLOv2, seen: Seen, box: Box, *, finest: int) -> Pointed | None:
    """The cap whose box is most like this one: left, top, right, bottom in the scaled photo."""
    left, top, right, bottom = box
    middle = np.array([[(left + right) / 2, (top + bottom) / 2]])

    def rating(candidates: Candidates, piece: SeenPiece) -> Tensor:
        likeness = candidates.scores.new_zeros(len(candidates.scores))
        seen_there = (candidates.scores > 0).nonzero().squeeze(1)
        boxes = boxes_of(candidates.logits[seen_there] > 0) * network.config.mask_stride
        corners = np.array([[left, top], [right, bottom]]) * piece.seen_in.enlarged
        wanted = boxes.new_tensor((corners - (piece.tile.x, piece.tile.y)).ravel())
        likeness[seen_there] = _box_iou(boxes, wanted)
        return likeness

    best = _best(network, seen, middle, rating)
    return None if best is None else _pointed(best, _drawn(network, seen, best, finest=finest))


def _pointed(chosen: _Chosen, window: Window) -> Pointed:
    return Pointed(score=chosen.score, window=window, kernel=chosen.kernel, piece=chosen.piece)


def _best_at(
    network: PRSOLOv2,
    seen: Seen,
    points: Points,
    labels: NDArray[np.bool_],
    *,
    all_of_them: bool = False,
) -> _Chosen | None:
    """The mask that agrees with most clicks, and of those the surest; it holds one of the points it is to.

    ``all_of_them``: it must agree with every click.
    """

    def rating(candidates: Candidates, piece: SeenPiece) -> Tensor:
        places = _in_piece(points, piece)
        values = logits_at(candidates, places, stride=network.config.mask_stride)
        wanted = torch.from_numpy(labels).to(values.device)
        right = ((values > 0) == wanted).sum(1)
        fits = ((values > 0) & wanted).any(1) & (candidates.scores > 0)
        if all_of_them:
            fits &= right == len(labels)
        return torch.where(fits, right + candidates.scores, 0.0)

    return _best(network, seen, points[labels], rating)


def _best(network: PRSOLOv2, seen: Seen, points: Points, rating: Rating) -> _Chosen | None:
    """The best-rated mask at the points, of the passes that are for caps of its size, if there is one."""
    found: list[_Chosen] = []
    for _, pieces in groupby(seen.pieces, key=lambda piece: piece.seen_in):
        piece = _piece_with(list(pieces), points[0])
        candidates = candidates_at(network, piece, _in_piece(points, piece).clamp(min=0))
        rated = rating(candidates, piece)
        pixels = (candidates.logits > 0).sum((1, 2)) * network.config.mask_stride**2
        for nth in rated.argsort(descending=True).tolist():
            if rated[nth] > 0 and piece.seen_in.takes(float(pixels[nth]), slack=ABOUT):
                score, kernel, logits = (part[nth] for part in candidates)
                found.append(_Chosen(piece, float(rated[nth]), float(score), kernel, logits))
                break
    return max(found, key=lambda one: one.rating, default=None)


def _piece_with(pieces: Sequence[SeenPiece], point: NDArray[np.float64]) -> SeenPiece:
    """The piece of a pass in whose own part a point of the scaled photo lies."""
    x, y = point * pieces[0].seen_in.enlarged
    return next(piece for piece in pieces if piece.tile.owns(x, y))


def _in_piece(points: Points, piece: SeenPiece) -> Tensor:
    """Points of the scaled photo in the pixels of a piece."""
    moved = points * piece.seen_in.enlarged - (piece.tile.x, piece.tile.y)
    return torch.from_numpy(moved.astype(np.float32)).to(piece.outputs.feature.device)


def _drawn(network: PRSOLOv2, seen: Seen, chosen: _Chosen, *, finest: int) -> Window:
    """The window of a mask, its edge drawn by PointRend, in the scaled photo."""
    piece = chosen.piece
    sure = torch.ones(1, device=chosen.kernel.device)
    (refined,) = refine(
        network.point_head,
        piece.outputs.point_maps,
        Instances(sure, chosen.kernel[None], chosen.logits[None]),
        image=piece.index,
        mask_stride=network.config.mask_stride,
        finest=finest,
    )
    logits = refined.logits.float().cpu().numpy()
    window = Window(x=refined.x + piece.tile.x, y=refined.y + piece.tile.y, logits=logits)
    width, height = seen.scaled
    return cut(shrunk(window, enlarged=piece.seen_in.enlarged), width=width, height=height)


def _box_iou(boxes: Tensor, wanted: Tensor) -> Tensor:
    """(n,) IoU of boxes (n, 4), x, y, width, height, with one of left, top, right, bottom."""
    first, last = boxes[:, :2], boxes[:, :2] + boxes[:, 2:]
    common = (last.minimum(wanted[2:]) - first.maximum(wanted[:2])).clamp(min=0).prod(1)
    return common / (boxes[:, 2:].prod(1) + (wanted[2:] - wanted[:2]).prod() - common)
