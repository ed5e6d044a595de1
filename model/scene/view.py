"""Where the camera hangs, and what it makes of points, directions and the soil.

View coordinates: x and y as in the image, z towards the camera, all in pixels. A cap is small beside its
distance, so that within one cap the picture is a parallel projection along the ray through its middle.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fairyring.model.scene.growth import Floats, Rectangle


class View(NamedTuple):
    """A pinhole camera over the bed, looking at the soil in the middle of the picture."""

    width: int
    height: int
    distance: float
    """From the lens to that soil, px."""
    eye: Floats
    """(3,) on the bed."""
    right: Floats
    down: Floats
    ahead: Floats
    """(3,) unit vectors on the bed: along image x, along image y, away from the camera."""


class Ground(NamedTuple):
    """The plane of the soil as the camera sees it, float32 (height, width) each."""

    x: NDArray[np.float32]
    y: NDArray[np.float32]
    """On the bed."""
    z: NDArray[np.float32]
    """In the view."""


def hang_camera(*, width: int, height: int, pitch_deg: float, distance: float) -> View:
    """``distance`` in image widths; ``pitch_deg`` is 0 looking straight down, and looks up the picture."""
    pitch = np.radians(pitch_deg)
    ahead = np.array([0.0, -np.sin(pitch), -np.cos(pitch)])
    middle = np.array([width / 2, height / 2, 0.0])
    return View(
        width=width,
        height=height,
        distance=distance * width,
        eye=middle - distance * width * ahead,
        right=np.array([1.0, 0.0, 0.0]),
        down=np.array([0.0, np.cos(pitch), -np.sin(pitch)]),
        ahead=ahead,
    )


def project(view: View, points: Floats) -> tuple[Floats, Floats, Floats]:
    """Points on the bed (n, 3) → image (n, 2), magnification (n,), view z (n,)."""
    ray = points - view.eye
    depth = ray @ view.ahead
    scale = view.distance / depth
    middle = np.array([view.width / 2, view.height / 2])
    image = middle + scale[:, None] * np.stack([ray @ view.right, ray @ view.down], axis=1)
    return image, scale, view.distance - depth


def turn(view: View, points: Floats, directions: Floats) -> Floats:
    """Directions on the bed (n, 3) as seen at points on the bed (n, 3): (n, 3) in view coordinates."""
    ray = points - view.eye
    ray = ray / np.linalg.norm(ray, axis=1, keepdims=True)
    x = view.right - ray * (ray @ view.right)[:, None]
    y = view.down - ray * (ray @ view.down)[:, None]
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    y /= np.linalg.norm(y, axis=1, keepdims=True)
    return np.stack([(directions * axis).sum(axis=1) for axis in (x, y, -ray)], axis=1)


def see_ground(view: View) -> Ground:
    """The soil's plane under every pixel's centre."""
    x = np.arange(view.width)[None] + 0.5 - view.width / 2
    y = np.arange(view.height)[:, None] + 0.5 - view.height / 2
    # The camera is never turned about its own axis, so how far the soil is depends on the row alone.
    reach = -view.eye[2] / (view.distance * view.ahead[2] + y * view.down[2])
    bed_x = np.float32(view.eye[0]) + reach.astype(np.float32) * x.astype(np.float32)
    bed_y = view.eye[1] + reach * (view.distance * view.ahead[1] + y * view.down[1])
    z = view.distance - reach * view.distance
    shape = (view.height, view.width)
    rows = [np.broadcast_to(row.astype(np.float32), shape) for row in (bed_y, z)]
    return Ground(bed_x, rows[0], rows[1])


def bounds_of_ground(ground: Ground) -> Rectangle:
    """The smallest rectangle of the bed that holds all soil in the picture."""
    x, y = ground.x, ground.y
    return float(x.min()), float(y.min()), float(x.max()), float(y.max())
