"""Least-squares ellipses (section 5.1), and what can be said of a shape once it is found."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite, sqrt

import cv2
import cv2.typing
import numpy as np
from msgspec.structs import replace

from fairyring.model.geometry.shapes import Circle, Ellipse, Points, ellipse_of_rotated_box


def least_squares_ellipse(points: Points) -> Ellipse | None:
    """The ellipse of the least algebraic error (Fitzgibbon's direct fit); None if the points determine none.

    Five distinct points that do not lie on one line are the least that do.
    """
    return _fitted(points, cv2.fitEllipseDirect)


def hull_ellipse(points: Points) -> Ellipse | None:
    """OpenCV's `fitEllipse` of the corners of the points' convex hull; None if they determine no ellipse."""
    origin = points.mean(axis=0)
    corners = cv2.convexHull((points - origin).astype(np.float32), returnPoints=False)[:, 0]
    return _fitted(points[corners], cv2.fitEllipse)


def _fitted(points: Points, fit: Callable[..., cv2.typing.RotatedRect]) -> Ellipse | None:
    if len(points) < 5 or distinct_points(points) < 5:
        return None
    origin = points.mean(axis=0)
    # OpenCV works in float32: near the origin that is exact enough.
    local = (points - origin).astype(np.float32)
    if np.linalg.matrix_rank(local, tol=1e-3) < 2:
        return None
    found = ellipse_of_rotated_box(fit(local))
    if not all(map(isfinite, (found.cx, found.cy, found.a, found.b, found.theta_deg))) or found.b <= 0:
        return None
    return replace(found, cx=found.cx + float(origin[0]), cy=found.cy + float(origin[1]))


def distinct_points(points: Points) -> int:
    """How many different positions there are among n points."""
    return len(np.unique(points[:, 0] + 1j * points[:, 1]))


def mean_radius(shape: Circle | Ellipse) -> float:
    """Radius of the circle of the same area, pixels."""
    return shape.r if isinstance(shape, Circle) else sqrt(shape.a * shape.b)


def axis_ratio(shape: Circle | Ellipse) -> float:
    """Shorter over longer axis, in (0, 1]."""
    return 1.0 if isinstance(shape, Circle) else shape.b / shape.a


def grown(shape: Circle | Ellipse, by: float) -> Circle | Ellipse:
    """The shape with every semi-axis longer by this many pixels."""
    if isinstance(shape, Circle):
        return replace(shape, r=shape.r + by)
    return replace(shape, a=shape.a + by, b=shape.b + by)
