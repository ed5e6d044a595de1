"""One cap, true or predicted, as evaluation reads it from an annotation: its mask, centre and diameter."""

from __future__ import annotations

import math
from typing import Any

from msgspec import Struct

from fairyring.model.coco.annotations import (
    Entry,
    box_of,
    centre_of,
    drawn_of,
    is_ignored,
    is_marked,
    own_id,
    score_of,
    shape_of,
)
from fairyring.model.coco.ids import Id
from fairyring.model.coco.visible import outline_in, rle_in
from fairyring.model.contour.marks import whole_of_mark
from fairyring.model.geometry.mask_tracing import rim_of_mask
from fairyring.model.geometry.outline_checks import check_centre, check_mark
from fairyring.model.geometry.raster import Rle, area_of_rle, rle_of_outline
from fairyring.model.geometry.rle import checked_counts, cut_of_counts
from fairyring.model.geometry.shapes import (
    Centre,
    Circle,
    Outline,
    Polygon,
    Shape,
    centre_of_shape,
    diameter_of_shape,
    part_of_points,
)
from fairyring.model.json_values import ValueRefusedError, text


class CapRecord(Struct, frozen=True, kw_only=True):
    """One cap, true or predicted, as far as evaluation is concerned."""

    id: Id | None = None
    rle: Rle | None = None
    """The visible pixels; None where caps are paired by id."""
    score: float = 1.0
    """Score of a prediction, finite."""
    is_scored: bool = False
    """Whether its file gives it a score."""
    centre: Centre | None = None
    """Centre, pixels; None where nobody marked it, or a method refused it."""
    diameter: float | None = None
    """Diameter of the whole cap, pixels."""
    ignored: bool = False
    """Whether a true cap counts neither way."""
    area: float | None = None
    """Visible pixels; None where they are not known."""
    visible_share: float | None = None
    """Share of the whole cap that is in sight; None where no whole outline is stated."""
    mark: str | None = None
    """What its centre was taken from: polygon, circle, ellipse or centre; None of an outline alone."""
    shape: str | None = None
    """Regular or irregular, as a contour method found it."""


def cap_of(entry: Entry, *, width: int, height: int, masks: bool, centres: bool) -> CapRecord:
    """The cap of an annotation in an image of this size.

    Without ``masks`` its segmentation is not read; without ``centres`` it has no centre, and a diameter only
    where a circle or an ellipse is stated. Where no visible outline is stated, the whole one is its mask.
    Raises FairyringError, which does not say which annotation it is.
    """
    whole, score = _checked_shape(entry, width=width, height=height), score_of(entry)
    stated = whole
    outline, rle = _mask(entry, width=width, height=height) if masks else (None, None)
    if centres and whole is None and not entry.get("refusal"):
        whole = _fitted(outline, rle)
    area = _area(entry, rle) if centres else None
    return CapRecord(
        id=own_id(entry),
        rle=rle,
        # A shape without a score was drawn by somebody who was sure.
        score=1.0 if score is None else score,
        is_scored=score is not None,
        centre=_centre(entry, whole, width=width, height=height) if centres else None,
        diameter=diameter_of_shape(whole) if whole else _longer_side(entry) if centres else None,
        ignored=is_ignored(entry),
        area=area,
        visible_share=_visible_share(entry, stated, area) if centres else None,
        mark=_kind_of_mark(entry, stated) if centres else None,
        shape=text(entry.get("shape")) if centres else None,
    )


def _checked_shape(entry: Entry, *, width: int, height: int) -> Shape | None:
    shape = shape_of(entry)
    if shape is not None:
        check_mark(shape, width=width, height=height)
    return shape


def _mask(entry: Entry, *, width: int, height: int) -> tuple[Outline | None, Rle]:
    """The mask as polygons (None where the file has an RLE), and as RLE."""
    drawn = drawn_of(entry)
    if drawn is None:
        raise ValueRefusedError("It has neither a visible outline nor a circle or an ellipse.")
    if isinstance(drawn, dict):
        return None, rle_in(drawn, width=width, height=height)
    outline = outline_in(drawn, width=width, height=height)
    return outline, rle_of_outline(outline, width=width, height=height)


def _fitted(outline: Outline | None, rle: Rle | None) -> Shape | None:
    """The ellipse fitted to the polygon's vertices, of all its parts together, or to the rim of an RLE."""
    if outline is not None:
        return whole_of_mark(Polygon([figure for part in outline for figure in part]))
    if rle is None or area_of_rle(rle) == 0:
        return None
    height, _, counts = checked_counts(rle)
    cut, corner = cut_of_counts(height, counts)
    return whole_of_mark(Polygon(part_of_points(rim_of_mask(cut) + corner)))


def _centre(entry: Entry, whole: Shape | None, *, width: int, height: int) -> Centre | None:
    if entry.get("refusal"):
        return None
    stated = centre_of(entry)
    if stated is not None:
        return check_centre(stated, width=width, height=height)
    return None if whole is None else centre_of_shape(whole)


def _area(entry: Entry, rle: Rle | None) -> float | None:
    return _figure(entry.get("area")) if rle is None else float(area_of_rle(rle))


def _visible_share(entry: Entry, stated: Shape | None, area: float | None) -> float | None:
    """As ``occlude_rate`` says; else of the stated whole outline."""
    hidden = _figure(entry.get("occlude_rate"))
    if hidden is not None and 0 <= hidden <= 1:
        return 1 - hidden
    if stated is None or area is None:
        return None
    return min(area / (math.pi * (diameter_of_shape(stated) / 2) ** 2), 1.0)


def _kind_of_mark(entry: Entry, stated: Shape | None) -> str | None:
    if not is_marked(entry):
        return None
    if entry.get("mark"):
        return "polygon"
    if stated is not None:
        return "circle" if isinstance(stated, Circle) else "ellipse"
    return "centre" if entry.get("center") is not None else None


def _figure(value: Any) -> float | None:
    """A finite number; None for everything else, as other programs write what they like here."""
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return float(value) if is_number and math.isfinite(value) else None


def _longer_side(entry: Entry) -> float | None:
    """The longer side of its bbox: mostly the diameter, even of a cap that is partly hidden."""
    box = box_of(entry)
    return max(box[2:]) if box and max(box[2:]) > 0 else None
