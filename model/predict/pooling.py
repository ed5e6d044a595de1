"""What was seen in all pieces of a photo, in one: each cap once, each pixel one cap's."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from torch import Tensor

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


def pooled(pieces: Sequence[Piece], *, width: int, height: int, rim: float = 0.0) -> list[Found]:
    """The caps of a scaled photo of this size with overlaps resolved, in falling order of score.

    ``rim`` is added to all logits, which moves every rim outwards but for those that caps share.
    """
    found = [one for nth, _ in enumerate(pieces) for one in _taken(pieces, nth, width=width, height=height)]
    found.sort(key=lambda one: -one.score)
    kept = found if len(pieces) == 1 else list(_without_repeats(found))
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


def _without_repeats(found: Iterable[Found]) -> Iterator[Found]:
    """Without what lies for the most part on better and confident caps of other pieces; scores must fall."""
    better: list[Found] = []
    for one in found:
        held = one.window.logits > 0
        others = np.zeros(held.shape, bool)
        for other in better:
            if other.piece != one.piece:
                _mark_common(others, one.window, other.window)
        if np.count_nonzero(held & others) > MOST_TAKEN * np.count_nonzero(held):
            continue
        yield one
        if one.score >= CONFIDENT:
            better.append(one)


def _mark_common(marked: NDArray[np.bool_], window: Window, other: Window) -> None:
    """Marks, of a window's pixels (h, w), those that another one holds."""
    height, width = marked.shape
    left, top = max(window.x, other.x), max(window.y, other.y)
    right = min(window.x + width, other.x + other.logits.shape[1])
    bottom = min(window.y + height, other.y + other.logits.shape[0])
    if left < right and top < bottom:
        theirs = other.logits[top - other.y : bottom - other.y, left - other.x : right - other.x]
        marked[top - window.y : bottom - window.y, left - window.x : right - window.x] |= theirs > 0
