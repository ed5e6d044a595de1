"""The coordinate convention and the shapes everything else is made of."""

from __future__ import annotations

from msgspec import Struct


class Circle(Struct, frozen=True, tag="circle", tag_field="kind"):
    """Centre and radius, pixels."""

    cx: float
    cy: float
    r: float


class Ellipse(Struct, frozen=True, tag="ellipse", tag_field="kind"):
    """Centre, semi-axes a ≥ b, and the angle of a in [0, 180) degrees from +x towards +y."""

    cx: float
    cy: float
    a: float
    b: float
    theta_deg: float


class Polygon(Struct, frozen=True, tag="polygon", tag_field="kind"):
    """Vertices as a flat list [x0, y0, x1, y1, …]."""

    points: list[float]
