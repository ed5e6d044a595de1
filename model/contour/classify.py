"""Regular or irregular (section 5.1): concave defects, corners and the sub-contours between them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import pi, sqrt
from typing import Literal

import cv2
import numpy as np

from fairyring.model.geometry.shapes import Points


@dataclass(frozen=True, slots=True)
class Defect:
    """A concavity: the contour between two hull points, given by their index into it.

    ``end`` lies before ``start`` where the concavity spans the contour's first point.
    """

    start: int
    end: int
    chord: float
    """Distance between start and end, pixels."""
    depth: float
    """Largest distance of the contour from that chord, pixels."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Which concavities are shallow enough to ignore."""

    kind: Literal["relative", "printed"] = "relative"
    """Printed are 46/10, 69/30 and 89/40 px of chord or depth by length; by them no cap is ever irregular."""
    least_depth: float = 2.0
    """Least depth of a defect that counts, pixels."""
    share: float = 0.05
    """Least depth as a share of the diameter of the circle of equal area; 0.08 suits masks noisy by 2 px."""

    def ignore(self, defect: Defect, *, length: int, area: float) -> bool:
        """Whether a contour of ``length`` pixels around an ``area`` (px²) is regular in spite of it."""
        if self.kind == "printed":
            chord, depth = (46, 10) if length < 90 else (69, 30) if length < 180 else (89, 40)
            return defect.chord < chord or defect.depth < depth
        return defect.depth < max(self.least_depth, self.share * 2 * sqrt(area / pi))


def defects_of(contour: Points) -> list[Defect]:
    """All concavities of a closed contour of pixel centres, in order along it."""
    pixels = np.round(contour - 0.5).astype(np.int32)
    if len(pixels) < 4:
        return []
    hull = cv2.convexHull(pixels, returnPoints=False).reshape(-1)
    if len(hull) < 3:
        return []
    # A contour that touches itself gives hull indices out of order, which OpenCV refuses.
    ordered = np.sort(hull)[:, None].astype(np.int32)
    found = cv2.convexityDefects(pixels, ordered)
    if found is None:
        return []
    return [
        Defect(
            start=int(start),
            end=int(end),
            chord=float(np.hypot(*(contour[end] - contour[start]))),
            depth=float(depth) / 256,
        )
        # OpenCV 4 answers (n, 1, 4), OpenCV 5 (n, 4).
        for start, end, _, depth in found.reshape(-1, 4)
    ]


def corners_of(kept: list[Defect]) -> list[int]:
    """Section 5.2 (1): where the kept defects start and end, as sorted indices into the contour."""
    return sorted({index for defect in kept for index in (defect.start, defect.end)})


def sub_contours(contour: Points, corners: list[int]) -> list[Points]:
    """Section 5.2 (2): the contour cut at its corners, both ends included; the last piece wraps round.

    Without corners the whole contour is the one piece.
    """
    if len(corners) < 2:
        return [contour]
    closed = np.concatenate([contour, contour[: corners[0] + 1]])
    bounds = [*corners, len(contour) + corners[0]]
    return [closed[first : last + 1] for first, last in pairwise(bounds)]


def longest(pieces: list[Points]) -> Points:
    """Section 5.2 (3): the sub-contour of the most contour pixels."""
    return max(pieces, key=len)
