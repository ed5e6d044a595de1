"""The annotations of one image as lines of a COCO file, from nothing but what the database holds of them.

So another process can write them; what it is given goes there as MessagePack.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec
from msgspec import Raw, Struct

from fairyring.model.garbage import garbage_left_alone
from fairyring.storage.formats.coco_geometry import geometry_keys
from fairyring.storage.formats.coco_writing import annotation_entry, drawn, prediction_entry
from fairyring.storage.records import GivenVerdict, Image
from fairyring.storage.stored_caps import (
    StoredAnnotation,
    StoredPrediction,
    StoredRow,
    annotation_of_stored,
    origin_of,
    prediction_of_stored,
)

Lines = tuple[int, bytes]
"""How many annotations, and their text: one a line, a comma between them."""
NONE: Mapping[str, list[GivenVerdict]] = {}


class _Caps(Struct, frozen=True, kw_only=True):
    image: int
    size: tuple[int, int]
    annotations: list[StoredAnnotation]
    predictions: list[StoredPrediction]
    before_predictions: int
    verdicts: dict[str, list[GivenVerdict]]


_DECODER = msgspec.msgpack.Decoder(_Caps)


def packed(
    image: Image,
    *,
    annotations: Sequence[StoredRow] = (),
    predictions: Sequence[StoredRow] = (),
    before_predictions: int = 0,
    verdicts: Mapping[str, list[GivenVerdict]] = NONE,
) -> bytes:
    """The caps of an image that are written, for ``lines_of`` in any process.

    Args:
        image: theirs.
        annotations: the fields of a ``StoredAnnotation`` each.
        predictions: the fields of a ``StoredPrediction`` each.
        before_predictions: is added to the numbers of predictions.
        verdicts: what reviewers said of annotations, by uid.
    """
    return msgspec.msgpack.encode(
        {
            "image": image.id,
            "size": (image.width, image.height),
            "annotations": annotations,
            "predictions": predictions,
            "before_predictions": before_predictions,
            "verdicts": verdicts,
        }
    )


def lines_of(caps: bytes) -> Lines:
    """The annotations of an image, from what ``packed`` made."""
    encoder = msgspec.json.Encoder()
    with garbage_left_alone():
        read = _DECODER.decode(caps)
        stored = [*read.annotations, *read.predictions]
        annotations = [annotation_of_stored(each, image=read.image) for each in read.annotations]
        predictions = [prediction_of_stored(each, image=read.image) for each in read.predictions]
        where = [
            drawn(cap, visible_json=Raw(row.visible))
            for cap, row in zip([*annotations, *predictions], stored, strict=True)
        ]
        geometry = iter(geometry_keys(where, size=read.size))
        lines = [
            encoder.encode(
                annotation_entry(
                    cap,
                    next(geometry),
                    number=row.id,
                    category=row.category,
                    origin=origin_of(row),
                    verdicts=read.verdicts.get(cap.uid, ()),
                )
            )
            for cap, row in zip(annotations, read.annotations, strict=True)
        ]
        lines += [
            encoder.encode(
                prediction_entry(
                    cap, next(geometry), number=read.before_predictions + cap.id, category=row.category
                )
            )
            for cap, row in zip(predictions, read.predictions, strict=True)
        ]
    return len(lines), b",\n".join(lines)
