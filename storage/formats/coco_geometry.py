"""The keys of annotations that are geometry, for all caps of an image at once.

``segmentation``, ``bbox``, ``area`` and the whole outline come from one geometry, the outline as it is
written.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from fairyring.model.coco.writing import DECIMALS, occlusion_keys, rounded, shape_keys
from fairyring.model.geometry.clipping import clipped_outline
from fairyring.model.geometry.rings import Rings, areas_of, bounds_of, parts_of, rings_of, rings_of_shapes
from fairyring.model.geometry.shapes import Circle, Ellipse, GeometryError, Polygon, polygon_of_shape
from fairyring.model.geometry.uniting import united
from fairyring.storage.records import Mark, Outline, Shape

Size = tuple[int, int]


class Drawn(Struct, frozen=True, kw_only=True):
    """What is known of where a cap is."""

    visible: Outline
    mark: Mark | None = None
    whole: Shape | None = None


class _Outlines:
    """The outlines of an image's caps as they are written: their parts as rings, and whose each is."""

    def __init__(self, caps: Sequence[Drawn], size: Size) -> None:
        outlines = _inside([cap.visible or [_polygon_of(cap.mark)] for cap in caps], size)
        self.counts = np.array([len(outline) for outline in outlines], np.intp)
        self.owners: NDArray[np.intp] = np.repeat(np.arange(len(outlines)), self.counts)
        self.rings = _rounded(rings_of([part for outline in outlines for part in outline]))

    def lists(self) -> list[Outline]:
        parts, ends = parts_of(self.rings), np.cumsum(self.counts).tolist()
        return [parts[start:end] for start, end in zip([0, *ends], ends, strict=False)]

    def areas(self) -> list[float]:
        areas = np.bincount(self.owners, areas_of(self.rings), minlength=len(self.counts))
        return [round(area, DECIMALS) for area in areas.tolist()]

    def boxes(self) -> list[list[float]]:
        """Of each outline x, y, width, height."""
        starts = np.cumsum(self.counts) - self.counts
        least, greatest = bounds_of(self.rings)
        least, greatest = np.minimum.reduceat(least, starts), np.maximum.reduceat(greatest, starts)
        return np.round(np.hstack([least, greatest - least]), DECIMALS).tolist()


def written_outline(visible: Outline, mark: Mark | None, *, size: Size) -> Outline:
    """The ``segmentation`` of a cap: its visible outline, else its mark as a polygon."""
    (outline,) = _Outlines([Drawn(visible=visible, mark=mark)], size).lists()
    return outline


def geometry_keys(caps: Sequence[Drawn], *, size: Size) -> list[dict[str, Any]]:
    """The keys of each cap of an image; ``size`` is its width and height.

    Whole outlines are united with what is visible, as programs that know whole outlines expect that within,
    and no ellipse follows a cap exactly.
    """
    if not caps:
        return []
    outlines = _Outlines(caps, size)
    areas = outlines.areas()
    entries: list[dict[str, Any]] = [
        {"segmentation": outline, "bbox": box, "area": area}
        for outline, box, area in zip(outlines.lists(), outlines.boxes(), areas, strict=True)
    ]
    for entry, cap in zip(entries, caps, strict=True):
        if not cap.visible:
            entry["segmentation_of"] = "mark"
        if isinstance(cap.mark, Polygon):
            entry["mark"] = rounded(cap.mark.points)
    named = [(nth, shape_keys(cap.whole)) for nth, cap in enumerate(caps) if cap.whole is not None]
    wholes = _rounded(rings_of_shapes([_shape_of(keys) for _, keys in named]))
    amodal = _united([nth for nth, _ in named], wholes, outlines)
    for (nth, shape), outline, area in zip(named, amodal, areas_of(wholes).tolist(), strict=True):
        entry = entries[nth]
        entry |= shape
        entry["amodal_segmentation"] = outline
        if caps[nth].visible:
            entry |= occlusion_keys(areas[nth] / area)
    return entries


def _united(numbers: Sequence[int], wholes: Rings, outlines: _Outlines) -> list[Outline]:
    """Whole outlines, those of the caps of these numbers, with what is written of the caps."""
    place = np.full(len(outlines.counts), -1)
    place[numbers] = np.arange(len(numbers))
    is_seen = place[outlines.owners] >= 0
    rings = outlines.rings
    seen = Rings(rings.points[np.repeat(is_seen, rings.counts)], rings.counts[is_seen])
    found = united(wholes, seen, place[outlines.owners[is_seen]])
    parts = iter(parts_of(_rounded(rings_of([part for outline in found for part in outline]))))
    return [[next(parts) for _ in outline] for outline in found]


def _rounded(rings: Rings) -> Rings:
    return Rings(np.round(rings.points, DECIMALS), rings.counts)


def _shape_of(keys: dict[str, Any]) -> Shape:
    """The circle or ellipse as it is written."""
    return Circle(*keys["circle"]) if "circle" in keys else Ellipse(*keys["ellipse"])


def _inside(outlines: list[Outline], size: Size) -> list[Outline]:
    """What of them the photo shows; all of a mark beside the photo, which an annotation cannot do without."""
    rings = rings_of([part for outline in outlines for part in outline])
    least, greatest = bounds_of(rings)
    is_inside = (least >= 0).all(axis=1) & (greatest <= np.array(size)).all(axis=1)
    owners = np.repeat(np.arange(len(outlines)), [len(outline) for outline in outlines])
    for nth in np.unique(owners[~is_inside]).tolist():
        try:
            outlines[nth] = clipped_outline(outlines[nth], width=size[0], height=size[1])
        except GeometryError:
            continue
    return outlines


def _polygon_of(mark: Mark | None) -> list[float]:
    assert mark is not None, "a cap has an outline or a mark"
    return mark.points if isinstance(mark, Polygon) else polygon_of_shape(mark)
