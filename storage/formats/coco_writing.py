"""Writes COCO. ``formats.coco`` lists the keys that are ours and reads them back.

``bbox``, ``area`` and ``segmentation`` come from one geometry, the outline as it is written. Coordinates are
continuous and rounded to ``DECIMALS``; only keypoints are pixel indices, 0.5 less.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, BinaryIO

import msgspec
import numpy as np

from fairyring.model.geometry.shapes import (
    Circle,
    Ellipse,
    Polygon,
    area_of_outline,
    bounds_of_outline,
    keypoint_of_centre,
    polygon_of_shape,
)
from fairyring.storage.records import Annotation, Image, Mark, Outline, Prediction, Shape

DECIMALS = 4
KEYPOINTS = ["centre"]
RECONSTRUCTED, MARKED = 1, 2
"""Visibility of the keypoint: worked out, or placed by a person."""


def annotation_entry(annotation: Annotation, *, number: int, image: int, category: int) -> dict[str, Any]:
    """One annotation. ``image`` and ``category`` are numbers within the file."""
    cap = annotation.cap
    marked = cap.mark is not None
    whole, centre = annotation.whole, annotation.centre
    if isinstance(cap.mark, Circle | Ellipse):
        whole, centre = cap.mark, (cap.mark.cx, cap.mark.cy)
    entry = _geometry(cap.visible, cap.mark, whole)
    entry |= {"image_id": image, "category_id": category, "iscrowd": int(cap.ignored), "marked": marked}
    entry |= _centre(centre, visibility=MARKED if marked else RECONSTRUCTED)
    entry |= {"doubt": True} if cap.doubtful else {}
    entry |= {"ignored": True} if cap.ignored else {}
    entry |= {} if cap.order is None else {"order": cap.order}
    if annotation.revision == 1 and "amodal_segmentation" in annotation.extra:
        # Nobody has touched the cap since it was imported, so the file's own whole outline still holds.
        entry["amodal_segmentation"] = annotation.extra["amodal_segmentation"]
    return {"id": number} | annotation.extra | entry | {"uid": annotation.uid}


def prediction_entry(prediction: Prediction, *, number: int, image: int, category: int) -> dict[str, Any]:
    """One prediction, with its score."""
    entry = _geometry(prediction.visible, None, prediction.whole)
    entry |= {"image_id": image, "category_id": category, "iscrowd": 0, "score": prediction.score}
    entry |= _centre(prediction.centre, visibility=RECONSTRUCTED) | {"marked": False}
    return {"id": number} | prediction.extra | entry


def image_entry(image: Image, *, number: int, licenses: list[dict[str, Any]]) -> dict[str, Any]:
    """One image; its licence is entered into ``licenses`` and named by number."""
    entry: dict[str, Any] = {"id": number, "file_name": image.file_name}
    entry |= {"width": image.width, "height": image.height, "status": image.status}
    known = {"light": image.light, "form": image.form, "split": image.split}
    extra = dict(image.extra)
    license_ = extra.pop("license", None)
    if isinstance(license_, dict):
        extra["license"] = _number_of_license(license_, licenses)
    return extra | entry | {key: value for key, value in known.items() if value is not None}


def category_entry(name: str, extra: dict[str, Any], *, number: int) -> dict[str, Any]:
    """One category; its one keypoint is the centre."""
    return extra | {"id": number, "name": name, "keypoints": KEYPOINTS, "skeleton": []}


def write_document(file: BinaryIO, head: dict[str, Any], entries: Iterable[dict[str, Any]]) -> int:
    """Writes ``head`` and then the annotations one a line, so that half a million need no memory.

    Returns how many there were.
    """
    encoder = msgspec.json.Encoder()
    count = 0
    file.write(encoder.encode(head)[:-1] + b',\n"annotations": [')
    for entry in entries:
        file.write((b",\n" if count else b"\n") + encoder.encode(entry))
        count += 1
    file.write(b"\n]}\n")
    return count


def _geometry(visible: Outline, mark: Mark | None, whole: Shape | None) -> dict[str, Any]:
    outline = rounded(visible or [_polygon_of(mark)])
    entry: dict[str, Any] = {
        "segmentation": outline,
        "bbox": rounded([list(bounds_of_outline(outline))])[0],
        "area": round(area_of_outline(outline), DECIMALS),
    }
    if not visible:
        entry["segmentation_of"] = "mark"
    if isinstance(mark, Polygon):
        entry["mark"] = rounded([mark.points])[0]
    return entry | _whole(whole, outline if visible else None)


def _whole(whole: Shape | None, visible: Outline | None) -> dict[str, Any]:
    if whole is None:
        return {}
    numbers = rounded([list(msgspec.structs.astuple(whole))])[0]
    polygon = rounded([polygon_of_shape(type(whole)(*numbers))])
    key = "circle" if isinstance(whole, Circle) else "ellipse"
    entry: dict[str, Any] = {key: numbers, "amodal_segmentation": polygon}
    if visible is not None:
        hidden = 1 - area_of_outline(visible) / area_of_outline(polygon)
        entry["occlude_rate"] = round(min(max(hidden, 0.0), 1.0), DECIMALS)
    return entry


def _centre(centre: tuple[float, float] | None, *, visibility: int) -> dict[str, Any]:
    if centre is None:
        return {"center": None, "keypoints": [0, 0, 0], "num_keypoints": 0}
    x, y = rounded([list(keypoint_of_centre(centre))])[0]
    return {"center": rounded([list(centre)])[0], "keypoints": [x, y, visibility], "num_keypoints": 1}


def _polygon_of(mark: Mark | None) -> list[float]:
    assert mark is not None, "a cap has an outline or a mark"
    return mark.points if isinstance(mark, Polygon) else polygon_of_shape(mark)


def rounded(parts: Sequence[Sequence[float]]) -> list[list[float]]:
    """To ``DECIMALS``, so that what is written, read and written again stays the same."""
    return [np.round(np.asarray(part, dtype=np.float64), DECIMALS).tolist() for part in parts]


def _number_of_license(license_: dict[str, Any], licenses: list[dict[str, Any]]) -> int:
    plain = {key: value for key, value in license_.items() if key != "id"}
    for known in licenses:
        if known == plain | {"id": known["id"]}:
            return known["id"]
    licenses.append(plain | {"id": len(licenses) + 1})
    return len(licenses)
