"""What an annotation of a COCO document says, key by key.

An annotation is the dictionary that the file holds. Every function reads the keys it is about, so that a
reader is held up by what it needs alone, and raises ValueRefusedError where they hold something else.
"""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import msgspec

from fairyring.model.coco.ids import Id, id_of
from fairyring.model.geometry.shapes import (
    Centre,
    Circle,
    GeometryError,
    Outline,
    Polygon,
    Shape,
    canonical_ellipse,
    polygon_of_shape,
)
from fairyring.model.geometry.told_arcs import ToldArc, require_points
from fairyring.model.json_values import ValueRefusedError, flag, number, numbers

Entry = dict[str, Any]
Segmentation = list[Any] | dict[str, Any]
"""The parts of an outline, or an RLE; neither checked yet."""

IGNORED = ("iscrowd", "ignore", "ignored")
DOUBTFUL = ("doubt", "doubtful")
TOLD_ARCS = "told_arcs"


def own_id(entry: Entry) -> Id | None:
    """Its id; None where it has none that could be compared."""
    return id_of(entry.get("id"))


def segmentation_of(entry: Entry) -> Segmentation | None:
    """Its segmentation: parts (one flat list is one part) or an RLE; None where nothing is seen or drawn."""
    value = entry.get("segmentation")
    if value is None or value == []:
        return None
    if isinstance(value, dict):
        return value
    if not isinstance(value, list):
        raise ValueRefusedError("Its segmentation is neither a list of polygons nor an RLE.")
    return parts_of(value)


def drawn_of(entry: Entry) -> Segmentation | None:
    """Its visible outline; where the file does not say, its whole outline as a polygon."""
    segmentation = segmentation_of(entry)
    if segmentation is not None:
        return segmentation
    shape, mark = shape_of(entry), mark_of(entry)
    if shape is not None:
        return [polygon_of_shape(shape)]
    return None if mark is None else [mark.points]


def parts_of(polygons: list[Any]) -> list[Any]:
    """A list of parts; a flat list of coordinates is one part."""
    return polygons if isinstance(polygons[0], list) else [polygons]


def shape_of(entry: Entry) -> Shape | None:
    """Its circle, else its ellipse, finite and not checked any further; None without either."""
    if entry.get("circle") is not None:
        return Circle(*numbers(entry["circle"], "Its circle", count=3))
    if entry.get("ellipse") is not None:
        return canonical_ellipse(*numbers(entry["ellipse"], "Its ellipse", count=5))
    return None


def centre_of(entry: Entry) -> Centre | None:
    """Its ``center``; None without."""
    if entry.get("center") is None:
        return None
    x, y = numbers(entry["center"], "Its center", count=2)
    return x, y


def centre_sd_of(entry: Entry) -> tuple[float, float] | None:
    """How sure its centre is: ``mark_sd`` of a mark, else ``center_sd``; None where neither says so."""
    for key in ("mark_sd", "center_sd"):
        with suppress(ValueRefusedError):
            x, y = numbers(entry.get(key), key, count=2)
            if x >= 0 and y >= 0:
                return x, y
    return None


def mark_of(entry: Entry) -> Polygon | None:
    """The polygon a person marked: ``mark``, else a whole outline that is one polygon and no other shape."""
    mark = entry.get("mark")
    if mark is not None and not isinstance(mark, list):
        raise ValueRefusedError("Its mark is not a polygon.")
    if mark:
        return Polygon(mark)
    whole = entry.get("amodal_segmentation")
    if not isinstance(whole, list) or not whole or shape_of(entry) is not None:
        return None
    parts = parts_of(whole)
    return Polygon(parts[0]) if len(parts) == 1 else None


def is_marked(entry: Entry) -> bool:
    """Whether a person placed its shape and centre, rather than a machine."""
    if entry.get("marked") is not None:
        return flag(entry["marked"], "marked")
    # A machine that does not know how sure it is says so: center_sd is there, and null.
    return entry.get("score") is None and "center_sd" not in entry


def is_ignored(entry: Entry) -> bool:
    """Whether it counts neither way, in any of COCO's and our spellings."""
    return True in [flag(entry.get(key), key) for key in IGNORED if key in entry]


def is_crowd(entry: Entry) -> bool:
    """Whether it is a region of several caps."""
    return flag(entry.get("iscrowd"), "iscrowd")


def is_doubtful(entry: Entry) -> bool:
    """Whether somebody doubts it."""
    return True in [flag(entry.get(key), key) for key in DOUBTFUL if key in entry]


def told_arcs_of(entry: Entry) -> list[ToldArc]:
    """What people said of pieces of its outline; empty without."""
    try:
        arcs = msgspec.convert(entry.get(TOLD_ARCS) or [], list[ToldArc])
        require_points(arcs)
    except (msgspec.ValidationError, GeometryError) as error:
        raise ValueRefusedError("Its told_arcs are not a kind and points along the outline each.") from error
    return arcs


def score_of(entry: Entry) -> float | None:
    """Its score; None without, as of a cap that a person drew."""
    return None if entry.get("score") is None else number(entry["score"], "Its score")


def quality_of(entry: Entry) -> float | None:
    """The expected IoU of a prediction's outline with what is visible; None without.

    Others may mean something else by the word: it counts beside a score alone, and between 0 and 1.
    """
    quality = entry.get("quality")
    if score_of(entry) is None or isinstance(quality, bool) or not isinstance(quality, int | float):
        return None
    return float(quality) if 0 <= quality <= 1 else None


def box_of(entry: Entry) -> tuple[float, float, float, float] | None:
    """Its bbox: x, y, width and height, pixels."""
    if entry.get("bbox") is None:
        return None
    x, y, width, height = numbers(entry["bbox"], "Its bbox", count=4)
    return x, y, width, height


def outline_of_box(entry: Entry) -> Outline | None:
    """The rectangle of an annotation that has a bbox and nothing closer; None where there is none either.

    Raises ValueRefusedError where the box has no area: a turned one may have its corner elsewhere.
    """
    box = box_of(entry)
    if box is None or drawn_of(entry) is not None:
        return None
    if min(box[2:]) <= 0:
        raise ValueRefusedError(
            f"Its bbox is {box[2]:g} wide and {box[3]:g} high; after x and y it needs both above 0."
        )
    return [rectangle(*box)]


def rectangle(x: float, y: float, width: float, height: float) -> list[float]:
    """The corners of a box, [x0, y0, …]."""
    return [x, y, x + width, y, x + width, y + height, x, y + height]


def order_of(entry: Entry) -> int | None:
    """Its rank in the overlap order; a cap of higher order lies in front."""
    order = entry.get("order")
    if type(order) is float and order.is_integer():
        order = int(order)
    if order is not None and type(order) is not int:
        raise ValueRefusedError("“order” is not a whole number.")
    return order
