"""What the network sees in the best, a typical and the worst image of a set, drawn over the photos."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from fairyring.app.bench.network.sets import LabelledPhotos
from fairyring.app.bench.network.tables import CERTAIN
from fairyring.model.coco.document import document_of
from fairyring.model.errors import FileError
from fairyring.model.evaluate.masks import score_masks
from fairyring.model.evaluate.pages import pages_of, truth_of
from fairyring.model.geometry.shapes import Outline, points_of_part
from fairyring.model.photo import Pixels

TRUTH, FOUND, UNSURE = (255, 255, 0), (255, 0, 255), (120, 120, 255)
"""Colours, BGR: true outlines cyan, predictions magenta, those of a score below CERTAIN dull red."""
QUALITY = 85
SUBPIXEL = 4
"""Bits of a coordinate that OpenCV draws below a pixel."""


def draw_examples(predicted: dict[str, Any], photos: LabelledPhotos, out: Path) -> list[Path]:
    """Writes NAME-best.jpg, NAME-typical.jpg and NAME-worst.jpg, by AP, and returns them."""
    paged = pages_of(
        document_of(predicted), truth_of(document_of(photos.document), masks=True, centres=False)
    )
    pages = paged.pages
    scores = [score_masks([page]).ap or 0.0 for page in pages]
    order = np.argsort(scores)
    chosen = {"best": order[-1], "typical": order[len(order) // 2], "worst": order[0]}
    written = []
    images = list(photos.images())
    for name, nth in chosen.items():
        entry, pixels = images[nth]
        picture = _drawn(pixels, entry["id"], predicted, photos.document)
        caption = f"{entry['file_name']}: AP {scores[nth]:.3f}"
        cv2.putText(
            picture, caption, (12, 28), cv2.FONT_HERSHEY_SIMPLEX, 0.8, (255, 255, 255), 2, cv2.LINE_AA
        )
        path = out / f"{photos.name.replace(' ', '-')}-{name}.jpg"
        out.mkdir(parents=True, exist_ok=True)
        if not cv2.imwrite(str(path), picture, (cv2.IMWRITE_JPEG_QUALITY, QUALITY)):
            raise FileError(f"{path} cannot be written; give --pictures another folder.")
        written.append(path)
    return written


def _drawn(
    pixels: Pixels, image_id: Any, predicted: dict[str, Any], truth: dict[str, Any]
) -> NDArray[np.uint8]:
    picture = np.ascontiguousarray(pixels[:, :, ::-1])
    for cap in truth["annotations"]:
        if cap["image_id"] == image_id and not cap.get("ignore"):
            _outline(picture, cap["segmentation"], TRUTH)
    for cap in predicted["annotations"]:
        if cap["image_id"] == image_id:
            _outline(picture, cap["segmentation"], FOUND if cap["score"] >= CERTAIN else UNSURE)
    return picture


def _outline(picture: NDArray[np.uint8], outline: Outline, colour: tuple[int, int, int]) -> None:
    parts = [np.round((points_of_part(part) - 0.5) * 2**SUBPIXEL).astype(np.int32) for part in outline]
    cv2.polylines(picture, parts, isClosed=True, color=colour, lineType=cv2.LINE_AA, shift=SUBPIXEL)
