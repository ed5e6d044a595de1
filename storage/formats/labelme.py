"""Reads labelme's JSON: one file an image, shapes of several types.

A polygon is the visible outline of a cap or, where that is asked for, its mark too; a mask is a visible
outline. A rectangle is a box whose rim is to be corrected. A circle is exactly two points, the centre and one
on the rim: a mark without a visible outline. Shapes of one ``group_id`` and label are one cap: polygons are
its parts, a circle its mark.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from fairyring.model.coco.annotations import own_id, rectangle
from fairyring.model.geometry.shapes import Circle, Outline, Polygon
from fairyring.model.json_files import parse_json
from fairyring.model.json_values import ValueRefusedError, kept, number, numbers, size, text
from fairyring.storage.cap_validity import MAX_NAME
from fairyring.storage.choices import Polygons
from fairyring.storage.errors import StoreError
from fairyring.storage.formats.found import Found, FoundCap, FoundImage, Problem
from fairyring.storage.formats.fractions import require_pixels
from fairyring.storage.formats.labelme_masks import outline_of_png
from fairyring.storage.records import Cap, Mark

SHAPE_KEYS = {"label", "points", "group_id", "shape_type", "mask", "id", "uid"}
OUTLINES = ("polygon", "ellipse")
"""Types whose points are the vertices of a rim, where there are three and more."""
BOXES = ("rectangle", "rotation", "oriented_rectangle")
"""Types whose points are the corners of a box: two across, or all four."""
IMAGE_KEYS = {"version", "shapes", "imagePath", "imageData", "imageHeight", "imageWidth"}


def parse_labelme(data: bytes, *, file: str, polygons: Polygons = Polygons.visible) -> Found:
    """The image and caps of a labelme file.

    What is wrong with single shapes is in ``problems``.

    Raises:
        FairyringError: it is not a labelme file at all; the sentence does not name it.
    """
    document = parse_json(data)
    if not isinstance(document, dict) or not isinstance(document.get("shapes"), list):
        raise StoreError("This is not a labelme file: it has no list of shapes.")
    if not isinstance(document.get("imagePath"), str):
        raise StoreError("This does not name its image; set imagePath.")
    problems: list[Problem] = []
    shapes = list(_shapes(document["shapes"], problems, file=file))
    try:
        image = FoundImage(
            where="image",
            file_name=document["imagePath"],
            width=size(document.get("imageWidth"), "imageWidth"),
            height=size(document.get("imageHeight"), "imageHeight"),
            has_photo=isinstance(document.get("imageData"), str),
            extra=kept(
                {key: value for key, value in document.items() if key not in IMAGE_KEYS},
                left_out=lambda reason: problems.append(Problem(file, "image", reason)),
            ),
            caps=[_cap(group, polygons) for group in _grouped(shapes)],
        )
    except ValueRefusedError as error:
        raise StoreError(f"{error} Put it right, or export the file anew.") from error
    require_pixels(image.caps)
    return Found(
        file=file,
        images=[image],
        problems=problems,
        polygons=sum(shape.is_polygon for shape in shapes),
        labels=len(document["shapes"]),
    )


class _Shape:
    """One usable shape."""

    def __init__(self, entry: Any, where: str, left_out: Callable[[str], None]) -> None:
        if not isinstance(entry, dict) or not isinstance(entry.get("points"), list):
            raise ValueRefusedError("It has no points.")
        label, group = entry.get("label"), entry.get("group_id")
        if not isinstance(label, str) or not label.isprintable() or not 0 < len(label) <= MAX_NAME:
            longer = f", but of {len(label)}" if isinstance(label, str) and len(label) > MAX_NAME else ""
            raise ValueRefusedError(f"The label is not a line of 1 to {MAX_NAME} letters{longer}.")
        self.where = where
        self.label = label
        self.group = group if type(group) in (int, str) else None
        # Not labelme's own; it keeps them where whoever wrote the file has put them there.
        self.uid = text(entry.get("uid"))
        self.id = own_id(entry)
        kind = entry.get("shape_type") or "polygon"
        self.is_polygon = kind in OUTLINES
        self.is_box = kind in BOXES
        self.circle = _circle(entry) if kind == "circle" else None
        self.outline = _outline(entry, kind)
        others = {key: value for key, value in entry.items() if key not in SHAPE_KEYS and value}
        self.extra = kept(others, left_out=left_out)


def _outline(entry: dict[str, Any], kind: Any) -> Outline:
    """The parts of a shape's outline; none of a circle."""
    points = _points(entry)
    if kind == "circle":
        return []
    if kind == "mask":
        return outline_of_png(entry.get("mask"), corner=points[0] if points else (0, 0))
    if kind in BOXES and len(points) == 2:
        (left, top), (right, bottom) = np.sort(np.array(points), axis=0).tolist()
        return [rectangle(left, top, right - left, bottom - top)]
    if kind in (*OUTLINES, *BOXES):
        return [[coordinate for point in points for coordinate in point]]
    raise ValueRefusedError(f"Shapes of type {kind!r:.40} are not known here; draw a polygon or a circle.")


def _circle(entry: dict[str, Any]) -> Circle:
    points = _points(entry)
    if len(points) != 2:
        raise ValueRefusedError(
            f"A circle is two points, its centre and one on its rim; this has {len(points)}."
        )
    (cx, cy), (x, y) = points
    return Circle(cx, cy, number(math.hypot(x - cx, y - cy), "The radius"))


def _points(entry: dict[str, Any]) -> list[list[float]]:
    return [numbers(point, "A point", count=2) for point in entry["points"]]


def _shapes(entries: list[Any], problems: list[Problem], *, file: str) -> Iterable[_Shape]:
    for index, entry in enumerate(entries):
        where = f"shape {index + 1}"

        def report(reason: str, where: str = where) -> None:
            problems.append(Problem(file, where, reason))

        try:
            yield _Shape(entry, where, report)
        except ValueRefusedError as error:
            report(str(error))


def _grouped(shapes: Iterable[_Shape]) -> list[list[_Shape]]:
    groups: dict[Any, list[_Shape]] = {}
    for index, shape in enumerate(shapes):
        key = index if shape.group is None else (shape.label, shape.group)
        groups.setdefault(key, []).append(shape)
    return [part for group in groups.values() for part in _as_caps(group)]


def _as_caps(group: list[_Shape]) -> list[list[_Shape]]:
    """Divides a group with two circles or more into single shapes: some people group what grows together."""
    circles = sum(shape.circle is not None for shape in group)
    return [group] if circles < 2 else [[shape] for shape in group]


def _cap(group: list[_Shape], polygons: Polygons) -> FoundCap:
    parts = [part for shape in group for part in shape.outline]
    marks: list[Mark] = [shape.circle for shape in group if shape.circle is not None]
    if polygons is Polygons.marks and len(parts) == 1 and group[0].is_polygon:
        marks += [Polygon(parts[0])]
    is_box = any(shape.is_box for shape in group)
    return FoundCap(
        where=group[0].where,
        uid=group[0].uid,
        id=group[0].id if isinstance(group[0].id, int) else None,
        cap=Cap(
            visible=parts,
            mark=marks[0] if marks else None,
            doubtful=is_box,
            category=group[0].label,
        ),
        is_box=is_box,
        is_mask=any(not shape.is_polygon and not shape.is_box for shape in group if shape.outline),
        extra=group[0].extra,
    )
