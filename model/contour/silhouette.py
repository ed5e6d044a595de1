"""A cap's mask, cropped to its box, and the contour drawn around it.

OpenCV names a contour by the *indices* of the outermost pixels inside the mask. Here such a point is where
that pixel's centre lies, index + 0.5. The true edge runs a little outside it: see `RIM_INSET`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b
from itertools import takewhile
from math import ceil, floor, sqrt

import cv2
import msgspec
import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.model.geometry.raster import mask_of_outline
from fairyring.model.geometry.shapes import Outline, Points, centres_of_pixels, part_of_points, points_of_part
from fairyring.model.geometry.told_arcs import ToldArc

RIM_INSET = sqrt(2) / np.pi
"""How far the outermost pixel centres lie inside the edge that cut them: the mean of all directions, pixels.

Along an edge whose normal is (nx, ny) their distance to it is spread evenly over [0, max(|nx|, |ny|)).
"""


@dataclass(frozen=True, eq=False)
class Silhouette:
    """The visible part of one cap, 1 where it is seen; the first pixel is column ``left``, row ``top``.

    Two of the same pixels, of which the same is thought and said, are equal. A mask is never changed in
    place.
    """

    mask: NDArray[np.uint8]
    left: int
    top: int
    likely: LikelyEllipse | None = None
    """The whole outline that who drew this one held to be likely."""
    told: Sequence[ToldArc] = ()
    """What people said of pieces of its rim."""

    @property
    def box(self) -> tuple[int, int, int, int]:
        """Left, top, right, bottom of the mask."""
        rows, columns = self.mask.shape
        return self.left, self.top, self.left + columns, self.top + rows

    @cached_property
    def pixels(self) -> int:
        """How many pixels are visible."""
        return int(self.mask.sum())

    @cached_property
    def content(self) -> tuple[tuple[int, int, int, int], bytes, LikelyEllipse | None]:
        """The box, a digest of mask and said arcs, and what is likely: these tell silhouettes apart."""
        digest = blake2b(self.mask.tobytes(), digest_size=16)
        if self.told:
            digest.update(msgspec.json.encode(self.told))
        return self.box, digest.digest(), self.likely

    def __eq__(self, other: object) -> bool:
        return self is other or (isinstance(other, Silhouette) and self.content == other.content)

    def __hash__(self) -> int:
        return self._hash

    @cached_property
    def _hash(self) -> int:
        return hash(self.content)


NOTHING = Silhouette(np.zeros((0, 0), np.uint8), 0, 0)


def silhouette_of_outline(
    outline: Outline,
    *,
    width: int,
    height: int,
    likely: LikelyEllipse | None = None,
    told: Sequence[ToldArc] = (),
) -> Silhouette:
    """The pixels of an image of this size that an outline covers; what lies outside the image is cut off.

    ``told`` is what people said of pieces of it.
    Parts of fewer than three points cover nothing, nor does an outline with a coordinate that is not finite.
    ``likely``: the whole outline, as who drew this one sees it.
    """
    parts = [points_of_part(part) for part in outline if len(part) >= 6]
    if not parts or not all(np.isfinite(part).all() for part in parts):
        return NOTHING
    every = np.concatenate(parts)
    # Corners beyond the image are kept as they are: the rasteriser clips.
    left, top = (max(0, floor(low)) for low in every.min(axis=0))
    right, bottom = (
        min(size, ceil(high)) for size, high in zip((width, height), every.max(axis=0), strict=True)
    )
    if right <= left or bottom <= top:
        return NOTHING
    local = [part_of_points(part - (left, top)) for part in parts]
    mask = mask_of_outline(local, height=bottom - top, width=right - left)
    return Silhouette(mask, left, top, likely, told)


def contours_of(silhouette: Silhouette, *, least: float = 0) -> list[Points]:
    """The outer contours of all parts, the longest first, one point a contour pixel; holes are ignored.

    Parts with a contour shorter than ``least`` times the longest are left out: a torn mask has thousands.
    """
    if not silhouette.mask.any():
        return []
    found, _ = cv2.findContours(
        silhouette.mask,
        cv2.RETR_EXTERNAL,
        cv2.CHAIN_APPROX_NONE,
        offset=(silhouette.left, silhouette.top),
    )
    longest_first = sorted(found, key=len, reverse=True)
    worth_it = takewhile(lambda contour: len(contour) >= least * len(longest_first[0]), longest_first)
    return [centres_of_pixels(contour) for contour in worth_it]
