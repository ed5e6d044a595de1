"""Open predictions: those that show a cap which no annotation covers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.boxes import boxes_of_outlines, touching
from fairyring.model.geometry.raster import area_of_rle, iou_matrix, rle_of_outline
from fairyring.model.geometry.shapes import polygon_of_shape
from fairyring.storage.records import Annotation, Image, Outline, Prediction

SAME = 0.5
"""Least IoU of a prediction and an annotation of one cap."""
MOSTLY, ALIKE = 0.8, 0.3
"""Where one covers the first share of the other they are one cap, too, unless the IoU is below the second:
then a small cap lies on a large one."""


def offered(
    image: Image, annotations: Sequence[Annotation], predictions: Sequence[Prediction]
) -> list[Prediction]:
    """The open predictions: without those that lie on a live annotation which did not start from them.

    Compared are the visible outlines, or all of a mark placed without one. What mostly lies in an ignored
    region is left out as well, however small it is.
    """
    taken = {annotation.cap.prediction for annotation in annotations}
    asked = [prediction for prediction in predictions if prediction.id not in taken]
    spoken_of = [(covered, a.cap.ignored) for a in annotations if (covered := covered_by(a))]
    if not asked or not spoken_of:
        return list(predictions)
    outlines, ignored = [outline for outline, _ in spoken_of], np.array([flag for _, flag in spoken_of])
    known = _known(image, [prediction.visible for prediction in asked], outlines, ignored)
    labelled = {prediction.id for prediction, is_known in zip(asked, known, strict=True) if is_known}
    return [prediction for prediction in predictions if prediction.id not in labelled]


def _known(
    image: Image, seen: Sequence[Outline], said: Sequence[Outline], ignored: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """(n,) whether each of ``seen`` lies on one of ``said``; only those whose boxes touch are compared."""
    known = np.zeros(len(seen), bool)
    meeting = touching(boxes_of_outlines(seen), boxes_of_outlines(said))
    size = {"height": image.height, "width": image.width}
    masks = {nth: rle_of_outline(said[nth], **size) for nth in np.flatnonzero(meeting.any(axis=0)).tolist()}
    areas = {nth: area_of_rle(code) for nth, code in masks.items()}
    for row in np.flatnonzero(meeting.any(axis=1)).tolist():
        near = np.flatnonzero(meeting[row]).tolist()
        mask = rle_of_outline(seen[row], **size)
        iou = iou_matrix([mask], [masks[nth] for nth in near])[0]
        if iou.any():
            its_area, other_areas = area_of_rle(mask), np.array([areas[nth] for nth in near])
            shared = iou / (1 + iou) * (its_area + other_areas)
            mostly_in = shared >= MOSTLY * its_area
            mostly_around = shared >= MOSTLY * other_areas
            same = (iou >= SAME) | ((iou >= ALIKE) & (mostly_in | mostly_around))
            known[row] = (same | (mostly_in & ignored[near])).any()
    return known


def covered_by(annotation: Annotation) -> Outline:
    """What an annotation covers: what is visible of it, else all of a mark placed without an outline."""
    if annotation.cap.visible or annotation.whole is None:
        return annotation.cap.visible
    return [polygon_of_shape(annotation.whole)]
