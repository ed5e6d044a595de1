"""Annotations and predictions as evaluation reads them."""

from __future__ import annotations

from fairyring.model.evaluate.caps import CapRecord
from fairyring.model.geometry.raster import area_of_rle, rle_of_outline
from fairyring.model.geometry.shapes import area_of_outline, diameter_of_shape, polygon_of_shape
from fairyring.storage.open_predictions import covered_by
from fairyring.storage.records import Annotation, Image, Prediction, Shape


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


def prediction_record(prediction: Prediction, image: Image) -> CapRecord:
    """A prediction."""
    return CapRecord(
        id=prediction.id,
        rle=rle_of_outline(prediction.visible, height=image.height, width=image.width),
        score=prediction.score,
        centre=prediction.centre,
        diameter=diameter_of_shape(prediction.whole) if prediction.whole else None,
    )


def _visible_share(area: float | None, whole: Shape | None) -> float | None:
    if area is None or whole is None:
        return None
    return min(area / area_of_outline([polygon_of_shape(whole)]), 1.0)
