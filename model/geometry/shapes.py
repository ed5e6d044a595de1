"""The coordinate convention and the shapes everything else is made of.

Coordinates are continuous, in pixels of the upright image: x to the right, y down, and the centre of the
pixel in column i and row j at (i + 0.5, j + 0.5), so that an image covers [0, width] × [0, height].
What other programs mean otherwise is converted where it comes in or goes out, by the functions here:
OpenCV's contours and COCO's keypoints are pixel *indices*, 0.5 less in x and y.

An *outline* is a list of parts, each a flat list ``[x0, y0, x1, y1, …]`` of one closed polygon (the last
vertex joins the first). A part covers what lies inside by the even-odd rule; the parts are united. A hole
is reached over a bridge, a pair of edges run through in both directions.

``model.raster`` turns outlines into masks and back, and checks and repairs them; this file knows shapes
alone and needs only numpy.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from msgspec import Struct
from numpy.typing import ArrayLike, NDArray

from fairyring.model.errors import FairyringError

Outline = list[list[float]]
Points = NDArray[np.float64]
"""Points as an array (n, 2): x, y."""
Centre = tuple[float, float]


class GeometryError(FairyringError):
    """A shape that cannot be used; the sentence says what is wrong with it, not in which file."""


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


Shape = Circle | Ellipse
"""A whole outline, which goes on where the cap is hidden."""
Mark = Circle | Ellipse | Polygon
"""What a person placed for the centre."""


class Fit(Struct, frozen=True, kw_only=True):
    """The whole outline of one cap as it was worked out, or why there is none; pixels."""

    whole: Shape | None = None
    centre: Centre | None = None
    """Of the whole outline."""
    centre_sd: tuple[float, float] | None = None
    """One standard deviation of the centre along x and y; None where it is not known."""
    refusal: str | None = None
    """A sentence; then all else is None."""


def points_of_part(part: list[float]) -> Points:
    """The vertices of one part as an (n, 2) array."""
    return np.asarray(part, dtype=np.float64).reshape(-1, 2)


def part_of_points(points: ArrayLike) -> list[float]:
    """An (n, 2) array of vertices as one part."""
    return np.asarray(points, dtype=np.float64).ravel().tolist()


def without_repeats(points: Points) -> Points:
    """The vertices (n, 2) of a closed polygon that differ from the one before."""
    return points[(points != np.roll(points, 1, axis=0)).any(axis=1)]


def centres_of_pixels(indices: ArrayLike) -> Points:
    """Pixel indices, as in OpenCV's contours ((n, 2) or (n, 1, 2)), to the (n, 2) centres of those pixels."""
    return np.asarray(indices, dtype=np.float64).reshape(-1, 2) + 0.5


def keypoint_of_centre(centre: Centre) -> tuple[float, float]:
    """A centre as the x, y of a COCO keypoint, which is a pixel index."""
    return centre[0] - 0.5, centre[1] - 0.5


def canonical_ellipse(cx: float, cy: float, a: float, b: float, theta_deg: float) -> Ellipse:
    """The ellipse with semi-axis ``a`` at ``theta_deg``, longer or not, in the form Ellipse promises."""
    if a < b:
        a, b, theta_deg = b, a, theta_deg + 90.0
    # A tiny negative angle comes out of one modulo as 180.0 itself.
    return Ellipse(cx, cy, a, b, theta_deg % 180.0 % 180.0)


def ellipse_of_rotated_box(box: tuple[Sequence[float], Sequence[float], float]) -> Ellipse:
    """What ``cv2.fitEllipse`` returns (centre, full axes, degrees of the first) as an Ellipse.

    The centre is in the coordinates of the points that were fitted.
    """
    (cx, cy), (first, second), angle = box
    return canonical_ellipse(float(cx), float(cy), float(first) / 2, float(second) / 2, float(angle))


def polygon_of_shape(shape: Circle | Ellipse, *, chord_error: float = 0.1) -> list[float]:
    """One part whose vertices lie on the circle or ellipse, no edge further than ``chord_error`` px from it.

    An even number of vertices, at least 12, so that their mean and their fitted ellipse have the shape's
    own centre.
    """
    if isinstance(shape, Circle):
        shape = Ellipse(shape.cx, shape.cy, shape.r, shape.r, 0.0)
    # A chord of the unit circle sags by 1 - cos(π/n); the map to the ellipse stretches that by at most a.
    half_angle = math.acos(max(0.0, 1.0 - chord_error / max(shape.a, chord_error)))
    count = max(12, 2 * math.ceil(math.pi / half_angle / 2))
    return part_of_points(points_on_ellipse(shape, np.arange(count) * (2 * math.pi / count)))


def fit_of_shape(shape: Shape, *, centre_sd: tuple[float, float] | None = None) -> Fit:
    """A whole outline with the centre it has."""
    return Fit(whole=shape, centre=(shape.cx, shape.cy), centre_sd=centre_sd)


def centre_of_shape(shape: Shape) -> Centre:
    """The middle of a circle or an ellipse."""
    return shape.cx, shape.cy


def diameter_of_shape(shape: Shape) -> float:
    """Diameter of a circle, or of the circle of an ellipse's area, pixels."""
    return 2 * (shape.r if isinstance(shape, Circle) else math.sqrt(shape.a * shape.b))


def points_on_ellipse(ellipse: Ellipse, angles: ArrayLike) -> Points:
    """(n, 2) points at the parameter angles (radians, 0 on the semi-axis a, growing towards b)."""
    t = np.asarray(angles, dtype=np.float64)
    theta = math.radians(ellipse.theta_deg)
    along, across = ellipse.a * np.cos(t), ellipse.b * np.sin(t)
    x = ellipse.cx + along * math.cos(theta) - across * math.sin(theta)
    y = ellipse.cy + along * math.sin(theta) + across * math.cos(theta)
    return np.stack([x, y], axis=-1)


def signed_area(points: Points) -> float:
    """Shoelace area of one closed polygon (n, 2), px²; positive where it runs clockwise on the screen."""
    # The first vertex is the origin, so that the edge back to it adds nothing.
    x, y = (points - points[0]).T
    return 0.5 * float(x[:-1] @ y[1:] - y[:-1] @ x[1:])


def area_of_outline(outline: Outline) -> float:
    """Area in px² of a checked outline: the parts' areas added up (parts that overlap count twice)."""
    return sum(abs(signed_area(points_of_part(part))) for part in outline)


def bounds_of_outline(outline: Outline) -> tuple[float, float, float, float]:
    """(x, y, width, height) of the upright box around an outline; GeometryError where it is empty."""
    if not any(outline):
        raise GeometryError("The outline has no points.")
    left, right = _ends([part[0::2] for part in outline])
    top, bottom = _ends([part[1::2] for part in outline])
    return left, top, right - left, bottom - top


def _ends(coordinates: list[list[float]]) -> tuple[float, float]:
    """The least and the greatest; for so few numbers numpy takes longer."""
    return min(min(some) for some in coordinates if some), max(max(some) for some in coordinates if some)
