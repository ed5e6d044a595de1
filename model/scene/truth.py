"""What is known of every cap of a rendered bed."""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from model.geometry import Ellipse, Outline, ellipse_of_rotated_box, points_of_part
from model.raster import outline_of_mask
from model.scene.caps import Cap, polygon_of_cap
from model.scene.layers import Layer, Owners, window


class BedCap(NamedTuple):
    """One cap; coordinates are continuous, the stalk is no part of it."""

    visible: Outline
    """What is in sight: rasterises to exactly the cap's own pixels."""
    whole: list[float]
    """The whole outline as one part, also where hidden; it may leave the image."""
    ellipse: Ellipse
    """Least-squares fit to the whole outline."""
    order: int
    """A cap of higher order lies in front."""
    visible_fraction: float
    """Pixels in sight over pixels of the whole, those outside the image included."""
    diameter: float
    """Of the circle of the whole outline's area, px."""

    @property
    def centre(self) -> tuple[float, float]:
        """The ellipse's: of the whole cap as seen in the image."""
        return self.ellipse.cx, self.ellipse.cy


def tell_truth(caps: list[Cap], layers: list[Layer], owners: Owners) -> tuple[BedCap, ...]:
    """The caps with a pixel in sight, from the lowest to the highest; ``layers`` from lowest to highest."""
    told = []
    for layer in layers:
        here = window(layer.box)
        seen = owners[here] == layer.owner
        if layer.is_cap and seen.any():
            told.append(_cap_as_seen(caps[layer.mushroom], layer, seen, order=len(told), frame=owners.shape))
    return tuple(told)


def _cap_as_seen(
    cap: Cap, layer: Layer, seen: NDArray[np.bool_], *, order: int, frame: tuple[int, ...]
) -> BedCap:
    whole = polygon_of_cap(cap)
    return BedCap(
        visible=_outline_in_frame(seen, layer, frame),
        whole=whole,
        ellipse=_fitted(whole),
        order=order,
        visible_fraction=int(seen.sum()) / layer.area,
        diameter=2 * (layer.area / np.pi) ** 0.5,
    )


def _outline_in_frame(seen: NDArray[np.bool_], layer: Layer, frame: tuple[int, ...]) -> Outline:
    """Traced over the cap's own box, which the image's edges bound where the image bounds the cap."""
    mask = np.zeros(frame, np.uint8)
    mask[window(layer.box)] = seen
    return outline_of_mask(mask)


def _fitted(part: list[float]) -> Ellipse:
    """OpenCV fits in single precision, so about the outline's own middle."""
    points = points_of_part(part)
    middle = points.mean(axis=0)
    fit = ellipse_of_rotated_box(cv2.fitEllipse((points - middle).astype(np.float32)))
    return Ellipse(fit.cx + float(middle[0]), fit.cy + float(middle[1]), fit.a, fit.b, fit.theta_deg)
