"""The edges of a mask's pixels, joined into loops.

A *crack* is the unit edge between a covered pixel and one that is not. Cracks join into closed loops that
run clockwise on the screen around what is covered and anticlockwise around holes. Pixels that touch at a
corner belong together (8-connected); what is not covered does so only across an edge.

Time and memory go with the mask's pixels, which a few comparisons look at, and with the number of cracks.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import GeometryError, Points

STEPS = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
"""x, y of a crack by its heading; heading + 1 is a turn to the right, towards what is covered."""
INSIDE = np.array([[0, 0], [-1, 0], [-1, -1], [0, -1]])
"""x, y of the covered pixel beside a crack, relative to the lattice point where the crack starts."""
SOUTH, NORTH = 1, 3
MOST_CRACKS = 400_000
"""Most cracks of a mask; one with more is noise, or larger than any cap."""


@dataclass(frozen=True)
class Loop:
    """One closed chain of n cracks, in lattice coordinates."""

    starts: NDArray[np.int64]
    """(n, 2): x, y of where each crack starts."""
    headings: NDArray[np.int64]
    """(n,): rows of STEPS."""

    @property
    def midpoints(self) -> Points:
        """(n, 2): half way between a covered pixel's centre and its neighbour's."""
        return self.starts + STEPS[self.headings] / 2

    @property
    def inside(self) -> NDArray[np.int64]:
        """(n, 2): column, row of the covered pixel beside each crack."""
        return self.starts + INSIDE[self.headings]

    @property
    def outside(self) -> NDArray[np.int64]:
        """(n, 2): column, row of the pixel across each crack; it may lie outside the image."""
        return self.inside + STEPS[self.headings - 1]

    @property
    def corners(self) -> Points:
        """(m, 2): the lattice points where the loop turns; this polygon covers exactly the loop's pixels."""
        return self.starts[self.headings != np.roll(self.headings, 1)].astype(np.float64)

    def moved(self, offset: NDArray[np.int64]) -> Loop:
        """The same loop elsewhere; ``offset``: x, y."""
        return Loop(self.starts + offset, self.headings)


@dataclass(frozen=True)
class Piece:
    """One 8-connected piece of a mask."""

    outer: Loop
    holes: list[Loop]


@dataclass(frozen=True)
class Loops:
    """All m loops of a mask, their n cracks one loop after the other."""

    starts: NDArray[np.int64]
    """(n, 2): x, y of where each crack starts, in lattice coordinates of the mask."""
    headings: NDArray[np.int64]
    """(n,): rows of STEPS."""
    firsts: NDArray[np.int64]
    """(m,): where in the arrays above each loop begins. Outer loops come from the topmost down."""

    def __len__(self) -> int:
        return len(self.firsts)

    @cached_property
    def areas(self) -> NDArray[np.int64]:
        """(m,) pixels inside each loop, those of holes below zero."""
        if not len(self):
            return np.zeros(0, np.int64)
        return np.add.reduceat(self.starts[:, 0] * STEPS[self.headings, 1], self.firsts)

    @cached_property
    def outer(self) -> NDArray[np.int64]:
        """(m,) the outer loop of the piece that each loop belongs to: of an outer loop, itself.

        From a hole's leftmost edge its piece reaches leftwards to another crack: one of the outer loop, or of
        a hole that reaches further left.
        """
        loop = np.repeat(np.arange(len(self)), np.diff(self.firsts, append=len(self.headings)))
        holes = self.areas[loop] < 0
        facing = np.flatnonzero(holes & (self.headings == SOUTH))
        facing = facing[np.lexsort((self.starts[facing, 0], loop[facing]))]
        leftmost = facing[np.diff(loop[facing], prepend=-1) > 0]
        rising = np.flatnonzero(self.headings == NORTH)
        # A crack's place by the row of pixels it bounds, and from left to right.
        across = 1 + int(self.starts[:, 0].max(initial=0))
        places = (self.starts[rising, 1] - 1) * across + self.starts[rising, 0]
        order = np.argsort(places)
        wanted = self.starts[leftmost, 1] * across + self.starts[leftmost, 0]
        found = rising[order[np.searchsorted(places[order], wanted) - 1]]
        owner = np.arange(len(self))
        owner[loop[leftmost]] = loop[found]
        while (owner[owner] != owner).any():
            owner = owner[owner]
        return owner

    def pieces(self, kept: NDArray[np.bool_]) -> list[Piece]:
        """The pieces, from the topmost down, of the loops that ``kept`` (m,) keeps.

        A piece goes with its outer loop.
        """
        ends = np.append(self.firsts, len(self.headings))
        outer, inner = (np.flatnonzero(kept & side).tolist() for side in (self.areas > 0, self.areas < 0))
        holes: dict[int, list[Loop]] = {number: [] for number in outer}
        for number in inner:
            if (owner := int(self.outer[number])) in holes:
                holes[owner].append(self._loop(ends, number))
        return [Piece(outer=self._loop(ends, number), holes=found) for number, found in holes.items()]

    def _loop(self, ends: NDArray[np.int64], number: int) -> Loop:
        part = slice(ends[number], ends[number + 1])
        return Loop(starts=self.starts[part], headings=self.headings[part])


def loops_of_mask(mask: NDArray[np.uint8]) -> Loops:
    """All closed crack chains of a mask (height, width).

    Raises GeometryError where there are more than MOST_CRACKS.
    """
    covered = np.pad(mask != 0, 1)
    across = covered.shape[1] - 1
    keys = _cracks(covered)
    chains, firsts = _cycles(_successors(keys, across).tolist())
    headings = np.repeat(np.arange(4), [len(places) for places in keys])[chains]
    rows, columns = np.divmod(np.concatenate(keys)[chains], across)
    # The mask's own first lattice point is the padded one's (1, 1), where the arrays of cracks begin.
    return Loops(starts=np.stack([columns, rows], axis=1), headings=headings, firsts=firsts)


def _cracks(covered: NDArray[np.bool_]) -> list[NDArray[np.int64]]:
    """Where cracks start, by heading: ascending numbers of lattice points, row by row.

    The border of ``covered`` is False; the first lattice point is the corner of its first pixel inside.
    """
    nw, ne, sw, se = covered[:-1, :-1], covered[:-1, 1:], covered[1:, :-1], covered[1:, 1:]
    keys: list[NDArray[np.int64]] = []
    count = 0
    for inner, outer in ((se, ne), (sw, se), (nw, sw), (ne, nw)):
        leaving = inner > outer
        count += np.count_nonzero(leaving)
        if count > MOST_CRACKS:
            raise GeometryError(
                f"The mask's rim is longer than {MOST_CRACKS} pixels; smooth it, or scale it down."
            )
        keys.append(np.flatnonzero(leaving))
    return keys


def _successors(keys: list[NDArray[np.int64]], across: int) -> NDArray[np.int64]:
    """The number of the crack that follows each one, all four headings counted through.

    Turning left where there is a choice joins pixels that touch at a corner into one piece.
    """
    numbers = np.cumsum([0, *(len(places) for places in keys)])
    following = []
    for heading, places in enumerate(keys):
        ends = places + STEPS[heading] @ (1, across)
        successor = np.zeros(len(places), np.int64)
        for turned in ((heading + 1) % 4, heading, (heading - 1) % 4):
            place = np.searchsorted(keys[turned], ends)
            there = place < len(keys[turned])
            there[there] = keys[turned][place[there]] == ends[there]
            successor[there] = numbers[turned] + place[there]
        following.append(successor)
    return np.concatenate(following)


def _cycles(successor: list[int]) -> tuple[list[int], NDArray[np.int64]]:
    """The cycles of a permutation one after the other, and where each begins."""
    seen = bytearray(len(successor))
    chain: list[int] = []
    firsts: list[int] = []
    for first in range(len(successor)):
        if seen[first]:
            continue
        firsts.append(len(chain))
        index = first
        while not seen[index]:
            seen[index] = 1
            chain.append(index)
            index = successor[index]
    return chain, np.array(firsts, np.int64)
