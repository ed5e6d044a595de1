"""What is known of every cap of a rendered bed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fairyring.model.contour.ellipse import least_squares_ellipse
from fairyring.model.geometry.clipping import clipped_outline
from fairyring.model.geometry.mask_tracing import outline_of_mask
from fairyring.model.geometry.shapes import Ellipse, Outline, part_of_points, points_of_part
from fairyring.model.scene.caps import Box, Cap, polygon_of_cap
from fairyring.model.scene.layers import Owners, Seen, window


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


def tell_truth(caps: list[Cap], seen: list[Seen], owners: Owners) -> tuple[BedCap, ...]:
    """The caps with a pixel in sight; both from the lowest to the highest."""
    in_sight = [part for part in seen if part.layer.is_cap]
    return tuple(
        _cap_as_seen(caps[part.layer.mushroom], part, owners, order) for order, part in enumerate(in_sight)
    )


def _cap_as_seen(cap: Cap, part: Seen, owners: Owners, order: int) -> BedCap:
    whole = polygon_of_cap(cap)
    mask = (owners[window(part.box)] == part.layer.owner).astype(np.uint8)
    count = int(mask.sum())
    height, width = owners.shape
    all_in_sight = count == part.layer.area
    return BedCap(
        # Of a cap with every pixel in sight the outline may still end beyond the last pixel's middle.
        visible=clipped_outline([whole], width=width, height=height)
        if all_in_sight
        else _moved(outline_of_mask(mask), part.box),
        whole=whole,
        ellipse=_fitted(whole),
        order=order,
        visible_fraction=count / part.layer.area,
        diameter=2 * (part.layer.area / np.pi) ** 0.5,
    )


def _moved(outline: Outline, box: Box) -> Outline:
    """From a box to the image. It ends a pixel outside the cap or where the image does: nothing is cut."""
    return [part_of_points(points_of_part(part) + box[:2]) for part in outline]


def _fitted(part: list[float]) -> Ellipse:
    ellipse = least_squares_ellipse(points_of_part(part))
    assert ellipse is not None, "an outline of many directions around a point determines an ellipse"
    return ellipse
