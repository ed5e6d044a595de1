"""Outlines with sub-pixel edges: the lines along which a predicted cap's logits are 0."""

from __future__ import annotations

from itertools import pairwise

import cv2
import numpy as np
from contourpy import FillType, LineType, SerialContourGenerator, ZInterp
from numpy.typing import NDArray

from fairyring.model.geometry.bridges import join_holes
from fairyring.model.geometry.polygon_fit import fit_polygon
from fairyring.model.geometry.raster import box_of_mask
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
    rows, columns = box_of_mask(inside)
    # One more pixel on every side, of which those beyond the photo are surely none of the cap.
    top, left = rows.start - 1, columns.start - 1
    padded = np.full((rows.stop + 1 - top, columns.stop + 1 - left), -MOST_LOGIT)
    first_row, first = max(top, 0), max(left, 0)
    shown = logits[first_row : rows.stop + 1, first : columns.stop + 1]
    height, width = shown.shape
    here = np.s_[first_row - top : first_row - top + height, first - left : first - left + width]
    padded[here] = shown.clip(-MOST_LOGIT, MOST_LOGIT)
    filled = _level_lines(padded).filled(0.0, np.inf)
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
            # The middle of a pixel lies half a pixel in.
            points = join_holes(simple[0], simple[1:]) + 0.5 + (left, top)
            points = points.clip(0, logits.shape[::-1]) + corner
            outline.append(part_of_points(points.round(2)))
    return outline


def _level_lines(values: NDArray[np.float64]) -> SerialContourGenerator:
    """As ``contour_generator`` makes it, which looks for masked and infinite values first, and for longer."""
    height, width = values.shape
    columns, rows = np.meshgrid(np.arange(width, dtype=np.float64), np.arange(height, dtype=np.float64))
    return SerialContourGenerator(
        columns,
        rows,
        values,
        None,  # pyright: ignore[reportArgumentType]  # no mask, as contour_generator says it
        corner_mask=True,
        line_type=LineType.Separate,
        fill_type=FillType.OuterOffset,
        quad_as_tri=False,
        z_interp=ZInterp.Linear,
    )


def _simplified(ring: Points) -> Points:
    """A closed level line, whose last vertex repeats the first, with fewer vertices.

    They are fitted: chords between points of a cap's rim would all run inside of it.
    """
    points = ring[:-1]
    exact = points.astype(np.float32)
    kept = cv2.approxPolyDP(exact[:, None], TOLERANCE, closed=True).reshape(-1, 2)
    # Each point occurs once and is kept as it is: its two numbers, taken as one, tell it.
    places = {point: nth for nth, point in enumerate(exact.view(np.int64).ravel().tolist())}
    knots = np.array(sorted(places[point] for point in kept.view(np.int64).ravel().tolist()), np.int64)
    return fit_polygon(points, knots) if len(knots) >= 3 else points[knots]
