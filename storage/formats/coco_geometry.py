"""The keys of annotations that are geometry, for all caps of an image at once.

``segmentation``, ``bbox``, ``area`` and the whole outline come from one geometry, the outline as it is
written.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from msgspec import Raw, Struct
from msgspec.structs import astuple
from numpy.typing import NDArray

from fairyring.model.coco.writing import DECIMALS, hidden_shares, rounded
from fairyring.model.geometry.clipping import clipped_outline
from fairyring.model.geometry.rings import (
    Floats,
    Outlines,
    Rings,
    areas_of,
    bounds_of,
    lists_of,
    outlines_of,
    picked_outlines,
    rings_of_shapes,
)
from fairyring.model.geometry.shapes import Circle, GeometryError, Polygon, polygon_of_shape
from fairyring.model.geometry.uniting import united
from fairyring.storage.records import Mark, Outline, Shape

Size = tuple[int, int]


class Drawn(Struct, frozen=True, kw_only=True):
    """What is known of where a cap is."""

    visible: Outline
    visible_json: Raw | None = None
    """The same as text, where somebody has it: most outlines are written as they are."""
    mark: Mark | None = None
    whole: Shape | None = None


def written_outline(visible: Outline, mark: Mark | None, *, size: Size) -> Outline:
    """The ``segmentation`` of a cap: its visible outline, else its mark as a polygon."""
    outlines, _ = _inside([Drawn(visible=visible, mark=mark)], size)
    (outline,) = lists_of(_rounded(outlines))
    return outline


def geometry_keys(caps: Sequence[Drawn], *, size: Size) -> list[dict[str, Any]]:
    """The keys of each cap of an image; ``size`` is its width and height.

    Whole outlines are united with what is visible, as programs that know whole outlines expect that within,
    and no ellipse follows a cap exactly.
    """
    if not caps:
        return []
    outlines, is_cut = _inside(caps, size)
    written = _rounded(outlines)
    areas = [round(area, DECIMALS) for area in _areas_of(written).tolist()]
    entries: list[dict[str, Any]] = [
        {"segmentation": outline, "bbox": box, "area": area}
        for outline, box, area in zip(
            _segmentations(caps, written, is_cut | _differ(outlines, written)),
            _boxes_of(written),
            areas,
            strict=True,
        )
    ]
    for entry, cap in zip(entries, caps, strict=True):
        if not cap.visible:
            entry["segmentation_of"] = "mark"
        if isinstance(cap.mark, Polygon):
            entry["mark"] = rounded(cap.mark.points)
    _add_whole_outlines(entries, caps, written, np.array(areas))
    return entries


def _segmentations(
    caps: Sequence[Drawn], written: Outlines, is_changed: NDArray[np.bool_]
) -> list[Outline | Raw]:
    found: list[Outline | Raw | None] = [cap.visible_json for cap in caps]
    has_text = np.array([text is not None for text in found])
    numbers = np.flatnonzero(is_changed | ~has_text)
    for nth, outline in zip(numbers.tolist(), lists_of(picked_outlines(written, numbers)), strict=True):
        found[nth] = outline
    return [outline for outline in found if outline is not None]


def _add_whole_outlines(
    entries: list[dict[str, Any]], caps: Sequence[Drawn], outlines: Outlines, areas: Floats
) -> None:
    numbers = np.array([nth for nth, cap in enumerate(caps) if cap.whole is not None], np.intp)
    shapes = _rounded_shapes([cap.whole for cap in caps if cap.whole is not None])
    wholes = rings_of_shapes(shapes)
    wholes = Rings(np.round(wholes.points, DECIMALS), wholes.counts)
    amodal = lists_of(_rounded(united(wholes, picked_outlines(outlines, numbers))))
    hidden = hidden_shares(areas[numbers] / areas_of(wholes)).tolist()
    for nth, shape, outline, share in zip(numbers.tolist(), shapes, amodal, hidden, strict=True):
        entry = entries[nth]
        entry["circle" if isinstance(shape, Circle) else "ellipse"] = astuple(shape)
        entry["amodal_segmentation"] = outline
        if caps[nth].visible:
            entry["occlude_rate"] = share


def _rounded_shapes(shapes: Sequence[Shape]) -> list[Shape]:
    """The circles and ellipses as they are written."""
    if not shapes:
        return []
    figures = [astuple(shape) for shape in shapes]
    flat = np.round(np.array([figure for each in figures for figure in each]), DECIMALS).tolist()
    figure = iter(flat)
    return [type(shape)(*(next(figure) for _ in each)) for shape, each in zip(shapes, figures, strict=True)]


def _areas_of(outlines: Outlines) -> Floats:
    """(k,) px²."""
    return np.add.reduceat(areas_of(outlines.rings), outlines.starts)


def _boxes_of(outlines: Outlines) -> list[list[float]]:
    """Of each x, y, width, height."""
    least, greatest = bounds_of(outlines.rings)
    least = np.minimum.reduceat(least, outlines.starts)
    greatest = np.maximum.reduceat(greatest, outlines.starts)
    return np.round(np.hstack([least, greatest - least]), DECIMALS).tolist()


def _rounded(outlines: Outlines) -> Outlines:
    rings = outlines.rings
    return Outlines(Rings(np.round(rings.points, DECIMALS), rings.counts), outlines.counts)


def _differ(outlines: Outlines, others: Outlines) -> NDArray[np.bool_]:
    """(k,) whether vertices of each differ from those of another with as many."""
    moved = (outlines.rings.points != others.rings.points).any(axis=1)
    of_parts = np.logical_or.reduceat(moved, outlines.rings.starts)
    return np.logical_or.reduceat(of_parts, outlines.starts)


def _inside(caps: Sequence[Drawn], size: Size) -> tuple[Outlines, NDArray[np.bool_]]:
    """What the photo shows of their outlines, else of their marks; and which were cut (k,).

    Of a mark beside the photo it is all, which an annotation cannot do without.
    """
    drawn = [cap.visible or [_polygon_of(cap.mark)] for cap in caps]
    outlines = outlines_of(drawn)
    least, greatest = bounds_of(outlines.rings)
    is_inside = (least >= 0).all(axis=1) & (greatest <= np.array(size)).all(axis=1)
    is_cut = np.zeros(len(caps), np.bool_)
    for nth in np.unique(outlines.owners[~is_inside]).tolist():
        try:
            drawn[nth] = clipped_outline(drawn[nth], width=size[0], height=size[1])
        except GeometryError:
            continue
        is_cut[nth] = True
    return outlines_of(drawn) if is_cut.any() else outlines, is_cut


def _polygon_of(mark: Mark | None) -> list[float]:
    assert mark is not None, "a cap has an outline or a mark"
    return mark.points if isinstance(mark, Polygon) else polygon_of_shape(mark)
