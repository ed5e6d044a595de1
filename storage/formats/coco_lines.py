"""The annotations of one image as lines of a COCO file, from nothing but what they are given.

So another process can write them; what it is given goes there as MessagePack.
"""

from __future__ import annotations

from typing import Any

import msgspec
from msgspec import Struct

from fairyring.model.garbage import garbage_left_alone
from fairyring.storage.formats.coco_geometry import geometry_keys
from fairyring.storage.formats.coco_writing import annotation_entry, drawn, prediction_entry
from fairyring.storage.records import Annotation, GivenVerdict, Prediction

Lines = tuple[int, bytes]
"""How many annotations, and their text: one a line, a comma between them."""


class CapsOfImage(Struct, frozen=True, kw_only=True):
    """The caps of an image that are written, each with its number in the file."""

    size: tuple[int, int]
    """Width and height."""
    categories: dict[str, int]
    """Ids in the file, by name."""
    annotations: list[tuple[int, Annotation]] = []
    predictions: list[tuple[int, Prediction]] = []
    origins: dict[str, dict[str, Any]] = {}
    """Who made the annotations, by uid."""
    verdicts: dict[str, list[GivenVerdict]] = {}
    """What reviewers said of annotations, by uid."""


def lines_of(caps: CapsOfImage) -> Lines:
    """The annotations of an image."""
    numbered = [*caps.annotations, *caps.predictions]
    encoder = msgspec.json.Encoder()
    with garbage_left_alone():
        geometry = geometry_keys([drawn(cap) for _, cap in numbered], size=caps.size)
        lines = [
            encoder.encode(_entry(number, cap, keys, caps))
            for (number, cap), keys in zip(numbered, geometry, strict=True)
        ]
    return len(lines), b",\n".join(lines)


def packed(caps: CapsOfImage) -> bytes:
    """For another process."""
    return msgspec.msgpack.encode(caps)


def lines_of_packed(caps: bytes) -> Lines:
    """``lines_of`` what ``packed`` made."""
    with garbage_left_alone():
        return lines_of(msgspec.msgpack.decode(caps, type=CapsOfImage))


def _entry(
    number: int, cap: Annotation | Prediction, keys: dict[str, Any], caps: CapsOfImage
) -> dict[str, Any]:
    if isinstance(cap, Prediction):
        return prediction_entry(cap, keys, number=number, category=caps.categories[cap.category])
    return annotation_entry(
        cap,
        keys,
        number=number,
        category=caps.categories[cap.cap.category],
        origin=caps.origins[cap.uid],
        verdicts=caps.verdicts.get(cap.uid, ()),
    )
