"""What was seen in all pieces of a photo, in one: each cap once, each pixel one cap's."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from torch import Tensor

from fairyring.model.predict.level_lines import MOST_LOGIT
from fairyring.model.predict.overlaps import (
    CONFIDENT,
    MOST_TAKEN,
    Window,
    cut,
    resolve_overlaps,
    without_specks,
)
from fairyring.model.predict.passes import Pass, shrunk
from fairyring.model.predict.tiles import Tile

SLACK = 8.0
"""By how many pixels two pieces may differ about the middle of a cap at their seam."""
SAME = 0.6
"""IoU from which what two pieces saw is one cap; below, the surer alone is believed."""


@dataclass(frozen=True, kw_only=True)
class Piece:
    """The instances of a piece of a photo, refined to the pixels of the pass it was seen in."""

    seen_in: Pass
    tile: Tile
    scores: list[float]
    """Raw scores, in falling order."""
    windows: list[Window]
    """Their first pixels count from the tile's."""
    kernels: Tensor
    """(n, E)."""


@dataclass(frozen=True, kw_only=True)
class Found:
    """A cap in the scaled photo."""

    score: float
    """Raw."""
    window: Window
    piece: int
    """Index of the piece that it was taken from."""
    kernel: Tensor
    """(E,)."""
    agreement: float | None = None
    """IoU of what the passes saw that saw it; None where only one did."""


def pooled(pieces: Sequence[Piece], *, width: int, height: int, rim: float = 0.0) -> list[Found]:
    """The caps of a scaled photo of this size with overlaps resolved, in falling order of score.

    ``rim`` is added to all logits, which moves every rim outwards but for those that caps share.
    """
    found = [one for nth, _ in enumerate(pieces) for one in _taken(pieces, nth, width=width, height=height)]
    found.sort(key=lambda one: -one.score)
    kept = found if len(pieces) == 1 else _each_once(found)
    scores = [one.score for one in kept]
    shown = [replace(one.window, logits=one.window.logits + np.float32(rim)) for one in kept]
    windows = resolve_overlaps(shown, scores, width=width, height=height)
    return [replace(one, window=window) for one, window in zip(kept, windows, strict=True)]


def _taken(pieces: Sequence[Piece], nth: int, *, width: int, height: int) -> Iterator[Found]:
    """What is taken from a piece: caps of the sizes its pass is for, in the part that is the tile's own."""
    piece = pieces[nth]
    tile, enlarged = piece.tile, piece.seen_in.enlarged
    for score, window, kernel in zip(piece.scores, piece.windows, piece.kernels, strict=True):
        moved = Window(x=window.x + tile.x, y=window.y + tile.y, logits=window.logits)
        seen = without_specks(cut(moved, width=round(width * enlarged), height=round(height * enlarged)))
        rows, columns = np.nonzero(seen.logits > 0)
        if not len(rows) or not piece.seen_in.takes(len(rows)):
            continue
        middle = (
            seen.x + (columns.min() + columns.max() + 1) / 2,
            seen.y + (rows.min() + rows.max() + 1) / 2,
        )
        if tile.owns(*middle, slack=SLACK):
            shown = cut(shrunk(seen, enlarged=enlarged), width=width, height=height)
            yield Found(score=score, window=shown, piece=nth, kernel=kernel)


def _each_once(found: Iterable[Found]) -> list[Found]:
    """Without what lies for the most part on better and confident caps of other pieces; scores must fall.

    Where that is the same cap, seen twice, the two are brought together.
    """
    caps: list[list[Found]] = []
    for one in found:
        held = one.window.logits > 0
        taken, likeness = np.zeros(held.shape, bool), np.zeros(len(caps) + 1)
        for nth, (best, *_) in enumerate(caps):
            if best.piece != one.piece and best.score >= CONFIDENT:
                likeness[nth] = _take(taken, one.window, best.window)
        if np.count_nonzero(held & taken) <= MOST_TAKEN * np.count_nonzero(held):
            caps.append([one])
        elif likeness.max() >= SAME:
            caps[int(likeness.argmax())].append(replace(one, agreement=float(likeness.max())))
    return [_brought_together(views) for views in caps]


def _take(taken: NDArray[np.bool_], window: Window, other: Window) -> float:
    """Marks, of a window's pixels (h, w), those that another one holds; returns the IoU of the two."""
    height, width = taken.shape
    left, top = max(window.x, other.x), max(window.y, other.y)
    right = min(window.x + width, other.x + other.logits.shape[1])
    bottom = min(window.y + height, other.y + other.logits.shape[0])
    if left >= right or top >= bottom:
        return 0.0
    here = np.s_[top - window.y : bottom - window.y, left - window.x : right - window.x]
    theirs = other.logits[top - other.y : bottom - other.y, left - other.x : right - other.x] > 0
    taken[here] |= theirs
    common = np.count_nonzero(theirs & (window.logits[here] > 0))
    return common / max(np.count_nonzero(window.logits > 0) + np.count_nonzero(other.logits > 0) - common, 1)


def _brought_together(views: Sequence[Found]) -> Found:
    """The first, with the mean of all their logits, each as weighty as its score, and how well they agree.

    Outlines are closer to the true ones so than those of the surer alone: each pass errs in its own way.
    """
    if len(views) == 1:
        return views[0]
    windows = [one.window for one in views]
    left, top = min(each.x for each in windows), min(each.y for each in windows)
    right = max(each.x + each.logits.shape[1] for each in windows)
    bottom = max(each.y + each.logits.shape[0] for each in windows)
    mean = np.zeros((bottom - top, right - left), np.float32)
    weight = sum(one.score for one in views)
    for one, window in zip(views, windows, strict=True):
        # What lies beyond a window is surely none of the cap's.
        seen = np.full(mean.shape, -MOST_LOGIT, np.float32)
        height, width = window.logits.shape
        row, column = window.y - top, window.x - left
        seen[row : row + height, column : column + width] = window.logits.clip(-MOST_LOGIT, MOST_LOGIT)
        mean += np.float32(one.score / weight) * seen
    agreement = float(np.mean([one.agreement for one in views if one.agreement is not None]))
    return replace(views[0], window=Window(x=left, y=top, logits=mean), agreement=agreement)
