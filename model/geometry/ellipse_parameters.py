"""Ellipses as five numbers that vary smoothly: the centre, log r, u and v.

The ellipse is r·expm([[u, v], [v, −u]]) around its centre: r is the radius of the circle of its area, u and
v are 0 for a circle, and no angle jumps from 180° to 0°.
"""

from __future__ import annotations

import math

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import Circle, Ellipse, Shape, canonical_ellipse

Parameters = NDArray[np.float64]
"""(5,): centre x, y, log r, u, v; pixels."""


class LikelyEllipse(Struct, frozen=True, kw_only=True):
    """A whole outline that somebody holds to be likely, and how surely."""

    parameters: tuple[float, float, float, float, float]
    """Centre x, y, log r, u, v; pixels."""
    covariance: tuple[tuple[float, ...], ...]
    """(5, 5), of x/r, y/r, log r, u and v."""

    @property
    def ellipse(self) -> Ellipse:
        """The most likely one."""
        return ellipse_of(np.array(self.parameters))

    @property
    def centre_sd(self) -> tuple[float, float]:
        """Standard deviation of its centre along x and y, pixels."""
        radius = math.exp(self.parameters[2])
        return radius * self.covariance[0][0] ** 0.5, radius * self.covariance[1][1] ** 0.5

    def enlarged(self, by: NDArray[np.float64]) -> LikelyEllipse:
        """The same in a photo that is (2,) times as wide and high; its shape is held to stay as it is."""
        x, y, log_r, u, v = self.parameters
        grown = log_r + math.log(by.prod()) / 2
        return LikelyEllipse(
            parameters=(x * float(by[0]), y * float(by[1]), grown, u, v), covariance=self.covariance
        )


def parameters_of(shape: Shape) -> Parameters:
    """The five numbers of a circle or an ellipse."""
    if isinstance(shape, Circle):
        return np.array([shape.cx, shape.cy, math.log(shape.r), 0.0, 0.0])
    stretch, turn = math.log(shape.a / shape.b) / 2, 2 * math.radians(shape.theta_deg)
    log_r = math.log(shape.a * shape.b) / 2
    return np.array([shape.cx, shape.cy, log_r, stretch * math.cos(turn), stretch * math.sin(turn)])


def ellipse_of(parameters: Parameters) -> Ellipse:
    """The ellipse of five numbers."""
    cx, cy, log_r, u, v = parameters.tolist()
    stretch = math.hypot(u, v)
    angle = math.degrees(math.atan2(v, u)) / 2
    return canonical_ellipse(cx, cy, math.exp(log_r + stretch), math.exp(log_r - stretch), angle)


def moved_parameters(parameters: Parameters, motion: NDArray[np.float64]) -> Parameters:
    """Where a motion (2, 3) takes them that turns, mirrors, scales and shifts, but does not shear."""
    linear = motion[:, :2]
    scale = math.sqrt(abs(np.linalg.det(linear)))
    # The symmetric matrix [[u, v], [v, −u]] turns as a tensor does.
    turn = linear / scale
    u, v = parameters[3:]
    tensor = turn @ np.array([[u, v], [v, -u]]) @ turn.T
    centre = linear @ parameters[:2] + motion[:, 2]
    return np.array([*centre, parameters[2] + math.log(scale), tensor[0, 0], tensor[0, 1]])
