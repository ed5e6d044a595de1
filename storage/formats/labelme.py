"""Reads labelme's JSON: one file an image, polygons and circles.

A polygon is the visible outline of a cap or, where that is asked for, its mark too. A circle is exactly two
points, the centre and one on the rim: a mark without a visible outline. Shapes of one ``group_id`` and label
are one cap: polygons are its parts, a circle its mark.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

from fairyring.model.geometry.shapes import Circle, Polygon
from fairyring.model.json_files import parse_json
from fairyring.model.json_values import ValueRefusedError, kept, number, numbers, size
from fairyring.storage.cap_validity import MAX_NAME
from fairyring.storage.choices import Polygons
from fairyring.storage.errors import StoreError
from fairyring.storage.formats.found import Found, FoundCap, FoundImage, Problem
from fairyring.storage.records import Cap, Mark

SHAPE_KEYS = {"label", "points", "group_id", "shape_type"}
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
            extra=kept(
                {key: value for key, value in document.items() if key not in IMAGE_KEYS},
                left_out=lambda reason: problems.append(Problem(file, "image", reason)),
            ),
            caps=[_cap(group, polygons) for group in _grouped(shapes)],
        )
    except ValueRefusedError as error:
        raise StoreError(f"{error} Put it right, or export the file anew.") from error
    drawn = sum(isinstance(shape.geometry, Polygon) for shape in shapes)
    return Found(file=file, images=[image], problems=problems, polygons=drawn)


class _Shape:
    """One usable shape."""

    def __init__(self, entry: Any, where: str, left_out: Callable[[str], None]) -> None:
        if not isinstance(entry, dict) or not isinstance(entry.get("points"), list):
            raise ValueRefusedError("It has no points.")
        label, group = entry.get("label"), entry.get("group_id")
        if not isinstance(label, str) or not label.isprintable() or not 0 < len(label) <= MAX_NAME:
            raise ValueRefusedError("The label is not a short line of text.")
        self.where = where
        self.label = label
        self.group = group if type(group) in (int, str) else None
        self.geometry = _geometry(entry)
        others = {key: value for key, value in entry.items() if key not in SHAPE_KEYS and value}
        self.extra = kept(others, left_out=left_out)


def _geometry(entry: dict[str, Any]) -> Circle | Polygon:
    points = [numbers(point, "A point", count=2) for point in entry["points"]]
    kind = entry.get("shape_type", "polygon")
    if kind == "polygon":
        return Polygon([coordinate for point in points for coordinate in point])
    if kind != "circle":
        raise ValueRefusedError(
            f"Shapes of type {kind!r:.40} are not known here; draw a polygon or a circle."
        )
    if len(points) != 2:
        raise ValueRefusedError(
            f"A circle is two points, its centre and one on its rim; this has {len(points)}."
        )
    (cx, cy), (x, y) = points
    return Circle(cx, cy, number(math.hypot(x - cx, y - cy), "The radius"))


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
    circles = sum(isinstance(shape.geometry, Circle) for shape in group)
    return [group] if circles < 2 else [[shape] for shape in group]


def _cap(group: list[_Shape], polygons: Polygons) -> FoundCap:
    parts = [shape.geometry for shape in group if isinstance(shape.geometry, Polygon)]
    marks: list[Mark] = [shape.geometry for shape in group if isinstance(shape.geometry, Circle)]
    if polygons is Polygons.marks and len(parts) == 1:
        marks += parts
    return FoundCap(
        where=group[0].where,
        cap=Cap(
            visible=[part.points for part in parts],
            mark=marks[0] if marks else None,
            category=group[0].label,
        ),
        extra=group[0].extra,
    )
