"""The whole outline of a mark that a person placed (section 6.3.1), and how well the mark determines it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fairyring.model.contour.circle import enclosing_circle, pratt_circle
from fairyring.model.contour.ellipse import distinct_points, least_squares_ellipse, mean_radius
from fairyring.model.contour.guarded import ELLIPSE_FROM_DEG
from fairyring.model.contour.result import Reconstruction
from fairyring.model.geometry.shapes import Circle, Ellipse, Fit, Mark, Points, Polygon, fit_of_shape

CLICK_SD = 1.0
"""How far off its place a point is put, pixels (one standard deviation)."""
CLICK_SHARE = 0.04
"""The same in radii, where that is less: people zoom in on a small cap."""
MOST_SD = 0.1
"""A centre known no better than to this share of the radius is not determined."""
ONE_CLICK = 0.03
"""Neighbouring points nearer than this share of the radius around all are one that was clicked twice."""
FURTHEST = 1.6
"""An outline reaches no further than so many radii of the circle around its points."""
LEAST_RATIO = 0.3
"""Shorter over longer axis of the narrowest ellipse that is believed."""
INSTEAD = "Place a circle (C) around the cap, or more points all around its rim."


@dataclass(frozen=True)
class _Guess:
    """An outline through marked points, and how sure its centre is."""

    shape: Circle | Ellipse
    covered_deg: float
    """What of its rim lies between the points, without the widest gap between two of them."""
    sd: tuple[float, float]
    """One standard deviation of the centre along x and y, pixels."""
    worst: float
    """The same along the direction in which it is largest."""


def reconstruction_of_mark(mark: Mark) -> Reconstruction:
    """The whole outline of a checked mark, the deviation of its centre, and how it came about.

    A polygon gives an ellipse where its points go round enough of the rim, else a circle, which fewer points
    determine; where they determine neither, the refusal says so. The deviation follows from how many points
    there are and where on the rim they lie, each being off by `CLICK_SD`. A circle or an ellipse placed as a
    whole is taken to be off by as much as one point.
    """
    if not isinstance(mark, Polygon):
        sd, name = click_sd(mark), "circle" if isinstance(mark, Circle) else "ellipse"
        return Reconstruction(fit=fit_of_shape(mark, centre_sd=(sd, sd)), why=f"the marked {name}")
    vertices = np.asarray(mark.points, np.float64).reshape(-1, 2)
    points = _clicked_once(vertices)
    count = len(points)
    ellipse, circle = _ellipse_through(points), _circle_through(points)
    if ellipse is not None and ellipse.covered_deg >= ELLIPSE_FROM_DEG:
        return _told(ellipse, f"ellipse fitted to the {count} points of the marked polygon")
    if circle is not None:
        seen = f"{circle.covered_deg:.0f}° of the rim"
        return _told(circle, f"circle fitted to the {count} points of the marked polygon, which show {seen}")
    refusal = f"The mark determines no outline: its {count} points lie on too little of one rim. {INSTEAD}"
    return Reconstruction(fit=Fit(refusal=refusal), proposal="circle")


def whole_of_mark(mark: Mark) -> Circle | Ellipse | None:
    """The outline a mark stands for, however badly it determines it; None where it determines none at all.

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


def click_sd(shape: Circle | Ellipse) -> float:
    """How far off a point on the rim of a cap of this size is put, pixels."""
    return min(CLICK_SD, CLICK_SHARE * mean_radius(shape))


def _told(guess: _Guess, how: str) -> Reconstruction:
    proposal = "circle" if isinstance(guess.shape, Circle) else "ellipse"
    return Reconstruction(
        fit=fit_of_shape(guess.shape, centre_sd=guess.sd),
        why=f"{how}; its centre is known to {guess.worst:.1f} px",
        coverage_deg=guess.covered_deg,
        proposal=proposal,
    )


def _clicked_once(vertices: Points) -> Points:
    """The vertices (n, 2), those that follow each other closely as one in their middle."""
    within = ONE_CLICK * enclosing_circle(vertices).r
    groups: list[list[Points]] = [[vertices[0]]]
    for vertex in vertices[1:]:
        if np.hypot(*(vertex - groups[-1][0])) > within:
            groups.append([vertex])
        else:
            groups[-1].append(vertex)
    if len(groups) > 1 and np.hypot(*(groups[-1][-1] - groups[0][0])) <= within:
        groups[0] += groups.pop()
    return np.array([np.mean(group, axis=0) for group in groups])


def _ellipse_through(points: Points) -> _Guess | None:
    """An ellipse that can be believed, through the points or, of four or fewer, along their edges."""
    found = whole_of_mark(Polygon(points.ravel().tolist()))
    if not isinstance(found, Ellipse) or found.b < LEAST_RATIO * found.a:
        return None
    return _guess(found, points, parameters=5 if len(points) >= 5 else 3)


def _circle_through(points: Points) -> _Guess | None:
    found = pratt_circle(points) if len(points) >= 3 else None
    return None if found is None else _guess(found, points, parameters=3)


def _guess(shape: Circle | Ellipse, points: Points, *, parameters: int) -> _Guess | None:
    """None where the outline lies or reaches elsewhere than the points, or they leave it open."""
    around = enclosing_circle(points)
    longest = shape.r if isinstance(shape, Circle) else shape.a
    if longest > FURTHEST * around.r or np.hypot(shape.cx - around.cx, shape.cy - around.cy) > around.r:
        return None
    turned = _turned(shape, points)
    covariance = _covariance(_normals(shape, turned), parameters=parameters)
    if covariance is None:
        return None
    sd = click_sd(shape)
    worst = sd * float(np.sqrt(np.linalg.eigvalsh(covariance)[-1]))
    if worst > MOST_SD * mean_radius(shape):
        return None
    x, y = (sd * np.sqrt(np.diag(covariance))).tolist()
    gaps = np.diff(np.sort(turned), append=np.sort(turned)[0] + 2 * np.pi)
    return _Guess(shape, 360 - float(np.degrees(gaps.max())), (x, y), worst)


def _turned(shape: Circle | Ellipse, points: Points) -> NDArray[np.float64]:
    """(n,) the parameter angles in [0, 2π) at which the outline passes the points."""
    if isinstance(shape, Circle):
        shape = Ellipse(shape.cx, shape.cy, shape.r, shape.r, 0.0)
    x, y = (points - (shape.cx, shape.cy)).T
    theta = np.radians(shape.theta_deg)
    along, across = x * np.cos(theta) + y * np.sin(theta), y * np.cos(theta) - x * np.sin(theta)
    return np.arctan2(across / shape.b, along / shape.a) % (2 * np.pi)


def _normals(shape: Circle | Ellipse, turned: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) directions in which the rim faces there, radians."""
    if isinstance(shape, Circle):
        return turned
    facing = np.arctan2(np.sin(turned) / shape.b, np.cos(turned) / shape.a)
    return facing + np.radians(shape.theta_deg)


def _covariance(facing: NDArray[np.float64], *, parameters: int) -> NDArray[np.float64] | None:
    """(2, 2) covariance of the centre for points that are off by 1 across the rim; None where it is open.

    How far a rim that faces ``facing`` moves out with the centre, the radius and, of 5 parameters, the two
    that stretch it.
    """
    columns = [np.cos(facing), np.sin(facing), np.ones(len(facing)), np.cos(2 * facing), np.sin(2 * facing)]
    moves = np.column_stack(columns[:parameters])
    if len(moves) < parameters or np.linalg.matrix_rank(moves, tol=1e-6) < parameters:
        return None
    return np.linalg.inv(moves.T @ moves)[:2, :2]


def _along_edges(vertices: Points) -> Points:
    share = np.arange(16)[:, None, None] / 16
    following = np.roll(vertices, -1, axis=0)
    return (vertices + share * (following - vertices)).reshape(-1, 2)
