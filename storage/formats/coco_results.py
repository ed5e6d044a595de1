"""COCO's list of results: what ``loadRes`` of pycocotools reads, with masks as RLE and scores."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, BinaryIO

import msgspec

from fairyring.model.coco.writing import rounded
from fairyring.model.geometry.raster import area_of_rle, rle_of_outline
from fairyring.model.geometry.shapes import bounds_of_outline
from fairyring.storage.formats.coco_geometry import written_outline
from fairyring.storage.records import Prediction


def result_entry(prediction: Prediction, *, size: tuple[int, int], category: int) -> dict[str, Any]:
    """A prediction as a result; ``size`` is the image's width and height."""
    outline = written_outline(prediction.visible, None, size=size)
    rle = rle_of_outline(outline, width=size[0], height=size[1])
    return {
        "image_id": prediction.image,
        "category_id": category,
        "segmentation": rle,
        "score": prediction.score,
        **({} if prediction.quality is None else {"quality": prediction.quality}),
        "bbox": rounded(bounds_of_outline(outline)),
        "area": area_of_rle(rle),
    }


def write_results(file: BinaryIO, entries: Iterable[dict[str, Any]]) -> None:
    """Writes a list of results one a line."""
    encoder = msgspec.json.Encoder()
    file.write(b"[")
    for nth, entry in enumerate(entries):
        file.write((b",\n" if nth else b"\n") + encoder.encode(entry))
    file.write(b"\n]\n")
