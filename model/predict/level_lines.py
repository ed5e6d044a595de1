"""Outlines with sub-pixel edges: the lines along which a predicted cap's logits are 0."""

from __future__ import annotations

from itertools import pairwise

import cv2
import numpy as np
from contourpy import FillType, contour_generator
from numpy.typing import NDArray

from fairyring.model.geometry.bridges import join_holes
from fairyring.model.geometry.polygon_fit import fit_polygon
from fairyring.model.geometry.shapes import Outline, Points, part_of_points, signed_area
from fairyring.model.predict.overlaps import LEAST_PART

TOLERANCE = 0.2
"""How far a simplified outline may lie from the level line, pixels."""
LEAST_HOLE = 0.1
"""A hole of less than this share of its part is closed."""
MOST_LOGIT = 6.0
"""Logits are clipped to this: beyond, the line would move towards the surer of two pixels."""


def outline_of_logits(logits: NDArray[np.float32], *, corner: tuple[int, int]) -> Outline:
    """(h, w) logits → the outline of where they are above 0; ``corner``: x, y of the first pixel.

    Marching squares between the middles of pixels, the outside below 0. Empty where nothing is above 0.
    """
    inside = logits > 0
    if not inside.any():
        return []
    left, top, right, bottom = _box(inside)
    padded = np.pad(logits, 1, constant_values=-MOST_LOGIT)[top : bottom + 2, left : right + 2]
    padded = padded.clip(-MOST_LOGIT, MOST_LOGIT)
    filled = contour_generator(z=padded, fill_type=FillType.OuterOffset).filled(0.0, np.inf)
    loops = [
        [points[first:last] for first, last in pairwise(ends)] for points, ends in zip(*filled, strict=True)
    ]
    areas = [abs(signed_area(rings[0])) for rings in loops]
    outline = []
    for rings, area in zip(loops, areas, strict=True):
        if area < LEAST_PART * max(areas) or area < 1:
            continue
        holes = [ring for ring in rings[1:] if abs(signed_area(ring)) >= LEAST_HOLE * area]
        simple = [_simplified(ring) for ring in (rings[0], *holes)]
        if all(len(ring) >= 3 for ring in simple):
            # The padding moved every index by 1, the middle of a pixel lies half a pixel in.
            points = join_holes(simple[0], simple[1:]) - 0.5 + (left, top)
            points = points.clip(0, logits.shape[::-1]) + corner
            outline.append(part_of_points(points.round(2)))
    return outline


def _box(inside: NDArray[np.bool_]) -> tuple[int, int, int, int]:
    """Box around what is True, as left, top, right, bottom: its columns are ``left : right``.

    Of an array padded by 1, ``left : right + 2`` are those and one on either side.
    """
    columns, rows = np.flatnonzero(inside.any(0)), np.flatnonzero(inside.any(1))
    return int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1


def _simplified(ring: Points) -> Points:
    """A closed level line, whose last vertex repeats the first, with fewer vertices.

    They are fitted: chords between points of a cap's rim would all run inside of it.
    """
    points = ring[:-1]
    exact = points.astype(np.float32)
    kept = cv2.approxPolyDP(exact[:, None], TOLERANCE, closed=True).reshape(-1, 2)
    places = {tuple(point): nth for nth, point in enumerate(exact.tolist())}
    knots = np.unique([places[tuple(point)] for point in kept.tolist()])
    return fit_polygon(points, knots) if len(knots) >= 3 else points[knots]
