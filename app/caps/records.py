"""Annotations and predictions as evaluation reads them."""

from __future__ import annotations

from fairyring.model.contour.marks import LEAST_RATIO, reconstruction_of_mark
from fairyring.model.evaluate.cap_rows import visibility_class
from fairyring.model.evaluate.caps import CapRecord
from fairyring.model.evaluate.human_floor import cdr_of_noise
from fairyring.model.evaluate.repeated_marks import CapClass
from fairyring.model.evaluate.sizes import size_of_cap
from fairyring.model.geometry.raster import area_of_rle, rle_of_outline
from fairyring.model.geometry.shapes import (
    Circle,
    Ellipse,
    area_of_outline,
    diameter_of_shape,
    polygon_of_shape,
)
from fairyring.storage.open_predictions import covered_by
from fairyring.storage.records import Annotation, Image, Mark, Prediction, Shape

UNSURE = 0.05
"""A mark whose centre is off by more than this share of the cap's diameter is an unsure one."""


def truth_record(annotation: Annotation, image: Image) -> CapRecord:
    """An annotation; it has a centre only where somebody marked it."""
    cap, whole = annotation.cap, annotation.whole
    rle = rle_of_outline(covered_by(annotation), height=image.height, width=image.width)
    area = area_of_rle(rle) if cap.visible else None
    return CapRecord(
        id=annotation.uid,
        rle=rle,
        centre=annotation.centre if cap.mark is not None else None,
        diameter=diameter_of_shape(whole) if whole else None,
        ignored=cap.ignored,
        area=area,
        visible_share=_visible_share(area, whole),
        mark=type(cap.mark).__name__.lower() if cap.mark is not None else None,
    )


def sd_of_mark(annotation: Annotation) -> tuple[float, float] | None:
    """One standard deviation of the marked centre along x and y, pixels; None where none is marked or known.

    Worked out from the mark where it was not kept, as of most imports.
    """
    mark = annotation.cap.mark
    if mark is None or annotation.centre_sd is not None:
        return annotation.centre_sd if mark is not None else None
    return reconstruction_of_mark(mark).fit.centre_sd


def is_unsure(annotation: Annotation) -> bool:
    """Whether somebody marked a cap in such a way that its centre is hardly determined.

    So it is where the mark's points lie on too little of the rim, where there are too few of them, or the
    same again and again, and where an imported ellipse is narrower than any cap.
    """
    mark, sd, whole = annotation.cap.mark, sd_of_mark(annotation), annotation.whole
    if mark is None:
        return False
    if isinstance(mark, Ellipse):
        return mark.b < LEAST_RATIO * mark.a
    return sd is None or (whole is not None and max(sd) > UNSURE * diameter_of_shape(whole))


def floor_of_mark(annotation: Annotation, image: Image) -> float | None:
    """CDR, percent, that the mark of an annotation has by its geometry; None where that is not known."""
    sd = sd_of_mark(annotation)
    return None if sd is None else cdr_of_noise(sd, width=image.width, height=image.height)


def class_of_mark(record: CapRecord, mark: Mark | None, *, annotator: str) -> CapClass:
    """What kind of mark a cap has, and whose."""
    return CapClass(
        annotator=annotator,
        size=size_of_cap(record),
        shape=None if mark is None else shape_of_mark(mark),
        visibility=visibility_class(record.visible_share),
    )


def shape_of_mark(mark: Mark) -> str:
    """Regular caps are marked by circles, all others are not (section 6.3.1 of the paper)."""
    return "regular" if isinstance(mark, Circle) else "irregular"


def prediction_record(prediction: Prediction, image: Image) -> CapRecord:
    """A prediction."""
    rle = rle_of_outline(prediction.visible, height=image.height, width=image.width)
    return CapRecord(
        id=prediction.id,
        rle=rle,
        area=area_of_rle(rle),
        score=prediction.score,
        centre=prediction.centre,
        diameter=diameter_of_shape(prediction.whole) if prediction.whole else None,
    )


def _visible_share(area: float | None, whole: Shape | None) -> float | None:
    if area is None or whole is None:
        return None
    return min(area / area_of_outline([polygon_of_shape(whole)]), 1.0)
