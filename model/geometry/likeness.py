"""Whether two outlines are the same but for how a file writes them, and how much they overlap."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.boxes import boxes_of_outlines, touching
from fairyring.model.geometry.raster import iou_matrix, rle_of_outline
from fairyring.model.geometry.shapes import Outline

ROUNDING = 0.01
"""How far apart a vertex and its copy may lie, pixels: many tools write two decimals."""


def are_alike(one: Outline, other: Outline, *, within: float = ROUNDING) -> bool:
    """Whether two outlines have the same parts with the same vertices.

    Parts may come in any order; a part may begin at any vertex, run either way round, and be closed by its
    first vertex again.
    """
    if len(one) != len(other):
        return False
    left = [_vertices(part) for part in other]
    for part in one:
        vertices = _vertices(part)
        found = next((nth for nth, copy in enumerate(left) if _same_ring(vertices, copy, within)), None)
        if found is None:
            return False
        del left[found]
    return True


def overlaps(
    ones: Sequence[Outline], others: Sequence[Outline], *, width: int, height: int
) -> dict[tuple[int, int], float]:
    """IoU of the pairs, by their indices, that share pixels of an image of this size."""
    if not ones or not others:
        return {}
    near = touching(boxes_of_outlines(ones), boxes_of_outlines(others))
    masks = {
        nth: rle_of_outline(others[nth], width=width, height=height)
        for nth in np.flatnonzero(near.any(axis=0)).tolist()
    }
    found: dict[tuple[int, int], float] = {}
    for row in np.flatnonzero(near.any(axis=1)).tolist():
        columns = np.flatnonzero(near[row]).tolist()
        mask = rle_of_outline(ones[row], width=width, height=height)
        shared = iou_matrix([mask], [masks[nth] for nth in columns])[0]
        found |= {(row, nth): float(iou) for nth, iou in zip(columns, shared, strict=True) if iou > 0}
    return found


def _vertices(part: Sequence[float]) -> NDArray[np.float64]:
    """(n, 2), without a last vertex that is the first again."""
    points = np.asarray(part, np.float64).reshape(-1, 2)
    return points[:-1] if len(points) > 1 and np.array_equal(points[0], points[-1]) else points


def _same_ring(one: NDArray[np.float64], other: NDArray[np.float64], within: float) -> bool:
    if len(one) != len(other):
        return False
    for turned in (other, other[::-1]):
        starts = np.flatnonzero((np.abs(turned - one[0]) <= within).all(axis=1))
        if any((np.abs(np.roll(turned, -start, axis=0) - one) <= within).all() for start in starts):
            return True
    return False
