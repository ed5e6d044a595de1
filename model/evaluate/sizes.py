"""Classes of caps by size: COCO's, by what is in sight of them, and those too small for the paper, apart."""

from __future__ import annotations

import math

from fairyring.model.evaluate.caps import CapRecord

SMALL_PX = 30.0
"""Diameter, pixels, below which a cap counts apart from the others."""
MEDIUM_AREA, LARGE_AREA = 32.0**2, 96.0**2
"""Visible pixels from which on COCO calls an object medium or large."""
SIZES = ("s", "m", "l", "under_30_px")


def size_of_cap(cap: CapRecord) -> str | None:
    """One of SIZES, by visible area and diameter; where only one is known, by that; None without either."""
    area, diameter = cap.area, cap.diameter
    if area is None:
        if diameter is None:
            return None
        area = math.pi * (diameter / 2) ** 2 * (1.0 if cap.visible_share is None else cap.visible_share)
    if (diameter or 2 * math.sqrt(area / math.pi)) < SMALL_PX:
        return "under_30_px"
    return "s" if area < MEDIUM_AREA else "m" if area < LARGE_AREA else "l"
