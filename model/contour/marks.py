"""The whole outline of a mark that a person placed (section 6.3.1)."""

from __future__ import annotations

import numpy as np

from fairyring.model.contour.ellipse import distinct_points, least_squares_ellipse
from fairyring.model.geometry.shapes import Circle, Ellipse, Points, Polygon


def whole_of_mark(mark: Circle | Ellipse | Polygon) -> Circle | Ellipse | None:
    """The whole outline a mark stands for; None where a polygon determines no ellipse.

    A circle or an ellipse is its own outline. A polygon gives the ellipse fitted to its *vertices*,
    since those are what the person put on the rim: the edges between them cut inside it, which shrinks the
    outline and, where the vertices are spaced unevenly, shifts its centre (twice as far with 10 uneven
    vertices). A polygon of four vertices or fewer is sampled along its edges instead.
    """
    if not isinstance(mark, Polygon):
        return mark
    vertices = np.asarray(mark.points, np.float64).reshape(-1, 2)
    if len(vertices) < 3 or not np.isfinite(vertices).all():
        return None
    return least_squares_ellipse(vertices if distinct_points(vertices) >= 5 else _along_edges(vertices))


def _along_edges(vertices: Points) -> Points:
    share = np.arange(16)[:, None, None] / 16
    following = np.roll(vertices, -1, axis=0)
    return (vertices + share * (following - vertices)).reshape(-1, 2)
