"""Which predictions people are still asked about: those that show a cap nobody has spoken of."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.raster import area_of_rle, iou_matrix, rle_of_outline
from fairyring.model.geometry.shapes import polygon_of_shape
from fairyring.storage.records import Annotation, Image, Outline, Prediction

SAME = 0.5
"""IoU from which a prediction and an annotation are one cap."""
MOSTLY, ALIKE = 0.8, 0.3
"""One covers this share of the other: one cap too, unless an IoU below the second says that a small cap lies
on a large one."""


def offered(
    image: Image, annotations: Sequence[Annotation], predictions: Sequence[Prediction]
) -> list[Prediction]:
    """The predictions without those that lie on a live annotation which did not start from them.

    Compared are the visible outlines, or all of a mark placed without one. What mostly lies in an ignored
    region is left out as well, however small it is.
    """
    taken = {annotation.cap.prediction for annotation in annotations}
    asked = [prediction for prediction in predictions if prediction.id not in taken]
    spoken_of = [(covered, a.cap.ignored) for a in annotations if (covered := _covered_by(a))]
    if not asked or not spoken_of:
        return list(predictions)
    outlines, ignored = [outline for outline, _ in spoken_of], np.array([flag for _, flag in spoken_of])
    known = _known(image, [prediction.visible for prediction in asked], outlines, ignored)
    settled = {prediction.id for prediction, is_known in zip(asked, known, strict=True) if is_known}
    return [prediction for prediction in predictions if prediction.id not in settled]


def _known(
    image: Image, seen: Sequence[Outline], said: Sequence[Outline], ignored: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """(n,) whether each of ``seen`` lies on one of ``said``; only those whose boxes touch are drawn."""
    known = np.zeros(len(seen), bool)
    touching = _touching(seen, said)
    size = {"height": image.height, "width": image.width}
    drawn = {nth: rle_of_outline(said[nth], **size) for nth in np.flatnonzero(touching.any(axis=0)).tolist()}
    areas = {nth: area_of_rle(code) for nth, code in drawn.items()}
    for row in np.flatnonzero(touching.any(axis=1)).tolist():
        near = np.flatnonzero(touching[row]).tolist()
        mask = rle_of_outline(seen[row], **size)
        iou = iou_matrix([mask], [drawn[nth] for nth in near])[0]
        if iou.any():
            its_area, other_areas = area_of_rle(mask), np.array([areas[nth] for nth in near])
            shared = iou / (1 + iou) * (its_area + other_areas)
            mostly_in = shared >= MOSTLY * its_area
            mostly_around = shared >= MOSTLY * other_areas
            same = (iou >= SAME) | ((iou >= ALIKE) & (mostly_in | mostly_around))
            known[row] = (same | (mostly_in & ignored[near])).any()
    return known


def _touching(first: Sequence[Outline], second: Sequence[Outline]) -> NDArray[np.bool_]:
    """(n, m) whether the boxes of two outlines touch."""
    left, top, right, bottom = _boxes(first)[:, :, None].transpose(1, 0, 2)
    to_left, to_top, to_right, to_bottom = _boxes(second).T
    return (left <= to_right) & (right >= to_left) & (top <= to_bottom) & (bottom >= to_top)


def _boxes(outlines: Sequence[Outline]) -> NDArray[np.float64]:
    """(n, 4) left, top, right, bottom; pixels."""
    return np.array([_box(outline) for outline in outlines]).reshape(-1, 4)


def _box(outline: Outline) -> tuple[float, float, float, float]:
    xs = [x for part in outline for x in part[0::2]]
    ys = [y for part in outline for y in part[1::2]]
    return min(xs), min(ys), max(xs), max(ys)


def _covered_by(annotation: Annotation) -> Outline:
    if annotation.cap.visible or annotation.whole is None:
        return annotation.cap.visible
    return [polygon_of_shape(annotation.whole)]
