"""Circles through contour points: enclosing, algebraic, and the minimum-distance circle of Equation 9."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import Circle, Points


def enclosing_circle(points: Points) -> Circle:
    """The smallest circle around all points."""
    origin = points.mean(axis=0)
    (cx, cy), r = cv2.minEnclosingCircle((points - origin).astype(np.float32))
    return Circle(cx=cx + float(origin[0]), cy=cy + float(origin[1]), r=r)


def pratt_circle(points: Points) -> Circle | None:
    """Pratt's algebraic circle (1987), nearly unbiased on short arcs; None where the points lie on a line."""
    origin = points.mean(axis=0)
    x, y = (points - origin).T
    scale = float(np.sqrt(np.mean(x**2 + y**2)))
    if scale == 0:
        return None
    x, y = x / scale, y / scale
    z = x**2 + y**2
    design = np.column_stack([z, x, y, np.ones_like(z)])
    # Minimise |design @ A| under B² + C² − 4AD = 1, whose inverse matrix is the constant below.
    _, singular, rows = np.linalg.svd(design, full_matrices=False)
    if len(singular) < 3 or singular[2] < 1e-9 * singular[0]:
        return None
    if len(singular) < 4 or singular[3] < 1e-12 * singular[0]:
        a, b, c, d = np.linalg.svd(design)[2][-1]
    else:
        root = rows.T * singular @ rows
        inverse = np.array([[0, 0, 0, -0.5], [0, 1, 0, 0], [0, 0, 1, 0], [-0.5, 0, 0, 0]])
        values, vectors = np.linalg.eigh(root @ inverse @ root)
        a, b, c, d = np.linalg.solve(root, vectors[:, np.argsort(values)[1]])
    square = b**2 + c**2 - 4 * a * d
    if abs(a) < 1e-9 * np.hypot(b, c) or square <= 0:
        return None
    return Circle(
        cx=float(origin[0] - scale * b / (2 * a)),
        cy=float(origin[1] - scale * c / (2 * a)),
        r=float(scale * np.sqrt(square) / (2 * abs(a))),
    )


def circle_cost(points: Points, centre: NDArray[np.float64], radius: float) -> float:
    """Equation 9: f = Σ |distance of a point to the centre − r|, pixels."""
    return float(np.abs(np.hypot(*(points - centre).T) - radius).sum())


def minimum_distance_circle(points: Points) -> Circle | None:
    """The circle that minimises Equation 9, by iteratively reweighted least squares; None on a line.

    Starts from Pratt's circle. Each round solves the linearised problem with weights 1 / max(|e|, ε),
    ε falling from 1 px to 0.001 px. For a fixed centre the best radius is exactly the median distance.
    """
    start = pratt_circle(points)
    if start is None:
        return None
    centre, radius = np.array([start.cx, start.cy]), start.r
    best, best_cost = (centre, radius), circle_cost(points, centre, radius)
    for floor in np.geomspace(1, 1e-3, 30):
        away = points - centre
        distance = np.maximum(np.hypot(*away.T), 1e-9)
        weight = 1 / np.maximum(np.abs(distance - radius), floor)
        slope = np.column_stack([away / distance[:, None], np.ones(len(points))])
        normal = slope.T @ (weight[:, None] * slope)
        step = np.linalg.lstsq(normal, slope.T @ (weight * (distance - radius)), rcond=None)[0]
        centre = centre + step[:2]
        radius = float(np.median(np.hypot(*(points - centre).T)))
        cost = circle_cost(points, centre, radius)
        if cost < best_cost:
            best, best_cost = (centre, radius), cost
    (cx, cy), r = best
    return Circle(cx=float(cx), cy=float(cy), r=float(r))
