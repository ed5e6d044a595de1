"""Keys of other programs that say where a cap is or how it looks: no longer true once it was edited."""

from __future__ import annotations

import re
from typing import Any

GEOMETRIC = re.compile(
    "bbox|box|segm|mask|rle|poly|contour|outline|point|area|perimeter|cent[er]{2}|centroid|radius|diamet"
    "|ellipse|circle|axis|axes|angle|rotat|theta|width|height|size|shape|circular|eccentric|solidity"
    "|amodal|visib|hidden|occlu|truncat|fraction|coverage|refusal|iou|^source$",
    re.IGNORECASE,
)
"""Parts of their names."""
FEWEST_COORDINATES = 4
"""A list of so many numbers is taken for a box or an outline, whatever it is called."""


def without_geometry(keys: dict[str, Any]) -> dict[str, Any]:
    """The keys, at any depth, that hold nothing of a cap's geometry, by their names and by what they hold."""
    kept = {}
    for key, value in keys.items():
        rest = without_geometry(value) if isinstance(value, dict) else value
        emptied = rest == {} and value != {}
        if not GEOMETRIC.search(key) and not emptied and not _holds_coordinates(value):
            kept[key] = rest
    return kept


def _holds_coordinates(value: Any) -> bool:
    if not isinstance(value, list):
        return False
    numbers = sum(isinstance(item, int | float) and not isinstance(item, bool) for item in value)
    return numbers >= FEWEST_COORDINATES or any(_is_point_or_coordinates(item) for item in value)


def _is_point_or_coordinates(item: Any) -> bool:
    """What lies in a list of points: [x, y], {"x": …, "y": …}, or a polygon."""
    if isinstance(item, dict):
        return {"x", "y"} <= item.keys()
    pair = isinstance(item, list) and len(item) >= 2 and all(type(number) in (int, float) for number in item)
    return pair or _holds_coordinates(item)
