"""Keys of other programs that an edit makes untrue: where a cap is, how it looks, who has looked at it."""

from __future__ import annotations

import re
from typing import Any

OF_THE_SHAPE = re.compile(
    "bbox|box|segm|seg(_|$)|geojson|geometr|mask|rle|poly|contour|outline|point|area|perimeter|cent[er]{2}|centroid|radius|diamet"
    "|ellipse|circle|axis|axes|angle|rotat|orient|theta|width|height|size|shape|circular|eccentric|solidity"
    "|aspect|convex|concav|compact|elongat|feret|moment|hull|skelet|landmark|silhouette|bitmap|coord|vert(ex|ices)"
    "|corner|rect|crop|thumb|pixel|amodal|visib|hidden|occlu|truncat|overlap|fraction|coverage|refusal|iou|dice"
    "|embed|histogram|updated|modified|verif|review|approv|validat|^source$",
    re.IGNORECASE,
)
"""Parts of names of what is derived from a shape, and of what is said of one as it was."""
MEASURED = re.compile(
    "score|confid|probab|logit|certain|stabil|error|deviat|length|breadth|thick|distance|diagonal|extent"
    "|position|locat|direction|heading|tilt|skew|curv|rough|smooth|roundness|feature|border|bound|edge|ratio|intens"
    "|bright|luminan|contrast|blur|sharp|colou?r|rgb|hsv|gr[ae]y|texture|mean|median|std|varian|depth|surface|volume",
    re.IGNORECASE,
)
"""Parts of names that are a measurement where a number stands for them; a word may be somebody's own."""
SHORT = {
    *(
        "x",
        "y",
        "w",
        "h",
        "r",
        "cx",
        "cy",
        "dx",
        "dy",
        "rx",
        "ry",
        "xmin",
        "xmax",
        "ymin",
        "ymax",
        "xc",
        "yc",
    ),
    *("d", "occ", "lab"),
    *("left", "top", "right", "bottom", "major", "minor", "px", "mm", "cm", "yaw", "pitch", "roll", "hu"),
}
"""Whole words in names, likewise."""
DRAWN_AS_TEXT = re.compile(
    r"\s*(SRID=\d+;)?(MULTI)?(POLYGON|POINT|LINESTRING)\s*Z?M?\s*\("
    r"|\s*M\s*-?\d[\d.]*[ ,]+-?\d[\d.]*\s*[ LHVCSQTAZ]"
    "|data:image/|iVBORw0KGgo|/9j/",
    re.IGNORECASE,
)
"""How texts begin that are outlines (WKT, the paths of SVG) or pictures (PNG and JPEG in base 64)."""
WORD = re.compile("[A-Z]?[a-z]+|[A-Z]+")
FEWEST_COORDINATES = 4
"""A list of so many numbers is taken for a box or an outline, whatever it is called."""


def without_geometry(keys: dict[str, Any]) -> dict[str, Any]:
    """The keys, at any depth, that still hold after an edit, by their names and by what they hold."""
    kept = {}
    for key, value in keys.items():
        rest = without_geometry(value) if isinstance(value, dict) else value
        emptied = rest == {} and value != {}
        drawn = isinstance(value, str) and DRAWN_AS_TEXT.match(value) is not None
        if not (drawn or emptied or _tells_of_the_shape(key, value) or _holds_coordinates(value)):
            kept[key] = rest
    return kept


def _tells_of_the_shape(key: str, value: Any) -> bool:
    if OF_THE_SHAPE.search(key):
        return True
    words = {word.lower() for word in WORD.findall(key)}
    return _is_measured(value) and (MEASURED.search(key) is not None or not words.isdisjoint(SHORT))


def _is_measured(value: Any) -> bool:
    """Whether it is a number or a list of them."""
    if isinstance(value, list):
        return bool(value) and all(map(_is_measured, value))
    return isinstance(value, int | float) and not isinstance(value, bool)


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
