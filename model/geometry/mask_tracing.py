"""The rims of a mask as polygons: pixel edges, smooth fits to them, and bridges to holes.

A *crack* is the unit edge between a covered pixel and one that is not. Cracks join into closed loops that
run clockwise on the screen around what is covered and anticlockwise around holes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import Points, signed_area

STEPS = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
"""x, y of a crack by its heading; heading + 1 is a turn to the right, towards what is covered."""
INSIDE = np.array([[0, 0], [-1, 0], [-1, -1], [0, -1]])
"""x, y of the covered pixel beside a crack, relative to the lattice point where the crack starts."""
SMOOTHING_ROUNDS = 6
"""The fit's error halves each round, from under half a pixel."""


@dataclass(frozen=True)
class Loop:
    """One closed chain of n cracks, in lattice coordinates of the whole mask."""

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


@dataclass(frozen=True)
class Component:
    """One 8-connected piece of a mask."""

    mask: NDArray[np.uint8]
    """Its box cut out of the mask, one pixel wider on every side, without the other pieces."""
    corner: tuple[int, int]
    """x, y of that cut-out's first pixel in the mask: -1 for a piece at the border."""
    loops: list[Loop]
    """The outer one first, then the holes', in the cut-out's coordinates."""


def components_of_mask(mask: NDArray[np.uint8]) -> list[Component]:
    """The 8-connected pieces of a mask (height, width), from the topmost down."""
    padded = np.pad((mask != 0).view(np.uint8), 1)
    count, labels, boxes, _ = cv2.connectedComponentsWithStats(padded, connectivity=8)
    components = []
    for label in range(1, count):
        left, top, width, height = (int(value) for value in boxes[label, :4])
        piece = labels[top - 1 : top + height + 1, left - 1 : left + width + 1] == label
        loops = sorted(crack_loops(piece), key=lambda loop: signed_area(loop.corners), reverse=True)
        components.append(Component(mask=piece.view(np.uint8), corner=(left - 2, top - 2), loops=loops))
    return components


def rim_of_mask(mask: NDArray[np.uint8]) -> Points:
    """(n, 2): the points half way between inner and outer pixels, without those of holes."""
    rims = [piece.loops[0].midpoints + piece.corner for piece in components_of_mask(mask)]
    return np.concatenate(rims) if rims else np.zeros((0, 2))


def crack_loops(covered: NDArray[np.bool_]) -> list[Loop]:
    """All closed crack chains of a mask (height, width) whose border rows and columns are False."""
    nw, ne, sw, se = covered[:-1, :-1], covered[:-1, 1:], covered[1:, :-1], covered[1:, 1:]
    # Lattice point (x, y) of the arrays below is (x + 1, y + 1) of the mask: the border has no cracks.
    leaving = np.stack([se & ~ne, sw & ~se, nw & ~sw, ne & ~nw])
    headings, rows, columns = np.nonzero(leaving)
    ends = STEPS[headings] + np.stack([columns, rows], axis=1)
    left, right = (headings - 1) % 4, (headings + 1) % 4
    # Turning left where there is a choice joins pixels that touch at a corner into one component.
    following = np.where(
        leaving[left, ends[:, 1], ends[:, 0]],
        left,
        np.where(leaving[headings, ends[:, 1], ends[:, 0]], headings, right),
    )
    number = np.zeros(leaving.shape, np.int64)
    number[leaving] = np.arange(len(headings))
    successor = number[following, ends[:, 1], ends[:, 0]].tolist()
    starts = np.stack([columns, rows], axis=1) + 1
    return [Loop(starts=starts[chain], headings=headings[chain]) for chain in _cycles(successor)]


def _cycles(successor: list[int]) -> list[list[int]]:
    """The cycles of a permutation."""
    seen = bytearray(len(successor))
    cycles = []
    for first in range(len(successor)):
        if seen[first]:
            continue
        cycle, index = [], first
        while not seen[index]:
            seen[index] = 1
            cycle.append(index)
            index = successor[index]
        cycles.append(cycle)
    return cycles


def knots_of_loop(midpoints: Points, *, tolerance: float) -> NDArray[np.int64]:
    """Indices, ascending, of the midpoints (n, 2), at least 3, that a polygon within ``tolerance`` keeps."""
    kept = cv2.approxPolyDP(midpoints.astype(np.float32), tolerance, closed=True).reshape(-1, 2)
    if len(kept) < 3:
        return np.arange(len(midpoints))
    # Midpoints are multiples of a half and each occurs once, so they can be looked up as integers.
    height = 4 * int(midpoints[:, 1].max()) + 4
    keys = (midpoints * 2).astype(np.int64) @ (height, 1)
    order = np.argsort(keys)
    return np.sort(order[np.searchsorted(keys, (kept * 2).astype(np.int64) @ (height, 1), sorter=order)])


def fit_polygon(midpoints: Points, knots: NDArray[np.int64]) -> Points:
    """(k, 2) vertices of the closed polygon that runs closest, by least squares, to the midpoints (n, 2).

    ``knots`` (k ≥ 3, ascending) are the midpoints where one edge ends and the next begins. The normal
    equations of this piecewise linear fit are cyclic, tridiagonal and dominated by their diagonal, so
    a few Jacobi rounds solve them.
    """
    rotated = np.concatenate((midpoints[knots[0] :], midpoints[: knots[0]]))
    path = rotated[:, 0] + 1j * rotated[:, 1]
    starts = knots - knots[0]
    lengths = np.diff(starts, append=len(path))
    late = (np.arange(len(path)) - np.repeat(starts, lengths)) / np.repeat(lengths, lengths)
    early = 1 - late
    coupling = np.add.reduceat(early * late, starts)
    diagonal = np.add.reduceat(early**2, starts) + _before(np.add.reduceat(late**2, starts))
    target = np.add.reduceat(early * path, starts) + _before(np.add.reduceat(late * path, starts))
    vertices = path[starts]
    for _ in range(SMOOTHING_ROUNDS):
        vertices = (target - coupling * _after(vertices) - _before(coupling * vertices)) / diagonal
    return np.stack([vertices.real, vertices.imag], axis=1)


def _before(values: NDArray[Any]) -> NDArray[Any]:
    """Each one's predecessor round the loop (``np.roll`` takes longer than the sums here)."""
    return np.concatenate((values[-1:], values[:-1]))


def _after(values: NDArray[Any]) -> NDArray[Any]:
    return np.concatenate((values[1:], values[:1]))


def join_holes(outer: Points, holes: list[Points]) -> Points:
    """One closed polygon (n, 2) of an outer polygon and its holes, each reached over its shortest bridge.

    The nearest hole is joined first: a shortest bridge crosses nothing, since whatever it crossed would
    be nearer.
    """
    joined, waiting = outer, list(holes)
    while waiting:
        bridges = [_shortest_bridge(joined, hole) for hole in waiting]
        nearest = min(range(len(waiting)), key=lambda i: bridges[i][0])
        del waiting[nearest]
        _, joined, at_joined, hole, at_hole = bridges[nearest]
        joined = np.concatenate(
            [
                joined[: at_joined + 1],
                np.roll(hole, -at_hole, axis=0),
                hole[at_hole : at_hole + 1],
                joined[at_joined:],
            ]
        )
    return joined


def _shortest_bridge(first: Points, second: Points) -> tuple[float, Points, int, Points, int]:
    """Distance, both polygons with a vertex at either end of the bridge, and the index of that vertex.

    Two polygons that do not cross are nearest where one of them has a vertex.
    """
    there, edge_there, foot_there, vertex_here = _nearest_on_edges(second, first)
    back, edge_back, foot_back, vertex_there = _nearest_on_edges(first, second)
    if there <= back:
        second, at_second = _with_vertex(second, edge_there, foot_there)
        return there, first, vertex_here, second, at_second
    first, at_first = _with_vertex(first, edge_back, foot_back)
    return back, first, at_first, second, vertex_there


def _nearest_on_edges(polygon: Points, points: Points) -> tuple[float, int, Points, int]:
    """The least distance of a point from the polygon; the edge, the foot on it, and the point's index."""
    along = np.roll(polygon, -1, axis=0) - polygon
    square = np.maximum((along**2).sum(axis=1), 1e-12)
    offset = points[:, None, :] - polygon[None, :, :]
    share = np.clip((offset * along).sum(axis=2) / square, 0.0, 1.0)
    feet = polygon + share[:, :, None] * along
    distance = np.hypot(*np.moveaxis(points[:, None, :] - feet, 2, 0))
    point, edge = np.unravel_index(int(distance.argmin()), distance.shape)
    return float(distance[point, edge]), int(edge), feet[point, edge], int(point)


def _with_vertex(polygon: Points, edge: int, point: Points) -> tuple[Points, int]:
    """The polygon with ``point`` as a vertex on ``edge``, and that vertex's index."""
    end = (edge + 1) % len(polygon)
    for index in (edge, end):
        if np.array_equal(polygon[index], point):
            return polygon, index
    return np.insert(polygon, edge + 1, point, axis=0), edge + 1
