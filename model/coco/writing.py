"""The keys in which an annotation is written: of exports, of rendered beds, of ``fairyring contour``.

``segmentation``, ``bbox`` and ``area`` come from one geometry, the outline as it is written. Coordinates are
continuous, in pixels; only keypoints are pixel indices, 0.5 less.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from msgspec.structs import astuple
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import (
    Centre,
    Circle,
    Outline,
    Shape,
    area_of_outline,
    bounds_of_outline,
    keypoint_of_centre,
    polygon_of_shape,
)

DECIMALS = 4
RECONSTRUCTED, MARKED = 1, 2
"""Visibility of the keypoint that is the centre: worked out, or placed by a person."""


def rounded(numbers: Iterable[float]) -> list[float]:
    """Coordinates rounded to ``DECIMALS``, so that writing, reading and writing again changes nothing."""
    return [round(number, DECIMALS) for number in numbers]


def rounded_outline(outline: Outline) -> Outline:
    """The outline with every coordinate rounded to ``DECIMALS``."""
    return [np.round(np.asarray(part, dtype=np.float64), DECIMALS).tolist() for part in outline]


def outline_keys(outline: Outline) -> dict[str, Any]:
    """``segmentation``, ``bbox`` and ``area`` of a visible outline, which is written as it is."""
    return {
        "segmentation": outline,
        "bbox": rounded(bounds_of_outline(outline)),
        "area": round(area_of_outline(outline), DECIMALS),
    }


def shape_keys(shape: Shape) -> dict[str, Any]:
    """The key ``circle`` or ``ellipse`` of a whole outline."""
    return {"circle" if isinstance(shape, Circle) else "ellipse": rounded(astuple(shape))}


def whole_keys(shape: Shape, *, visible_area: float | None) -> dict[str, Any]:
    """``circle`` or ``ellipse``, its polygon, and how much of it is hidden where that is known."""
    entry = shape_keys(shape)
    written = type(shape)(*next(iter(entry.values())))
    entry["amodal_segmentation"] = rounded_outline([polygon_of_shape(written)])
    if visible_area is not None:
        entry |= occlusion_keys(visible_area / area_of_outline(entry["amodal_segmentation"]))
    return entry


def hidden_shares(visible_shares: NDArray[np.float64]) -> NDArray[np.float64]:
    """The ``occlude_rate`` of each of (k,) caps, by the share of its whole outline that is visible."""
    return np.round(np.clip(1 - visible_shares, 0.0, 1.0), DECIMALS)


def occlusion_keys(visible_share: float) -> dict[str, Any]:
    """``occlude_rate``: the share of the whole outline that is hidden or outside the photo."""
    return {"occlude_rate": float(hidden_shares(np.array([visible_share]))[0])}


def centre_keys(centre: Centre | None, *, visibility: int) -> dict[str, Any]:
    """``center``, and the same as COCO's one keypoint."""
    if centre is None:
        return {"center": None, "keypoints": [0, 0, 0], "num_keypoints": 0}
    x, y = rounded(keypoint_of_centre(centre))
    return {"center": rounded(centre), "keypoints": [x, y, visibility], "num_keypoints": 1}
