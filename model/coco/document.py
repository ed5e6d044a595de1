"""A COCO document, or a list of results, whose items are decoded one at a time.

A decoded annotation takes ten times the memory of its text, so that text is what is kept until somebody
reads it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import msgspec
from msgspec import Raw, Struct

from fairyring.model.coco.faults import Fault, Report, place_of
from fairyring.model.coco.ids import Id, id_of
from fairyring.model.errors import FairyringError, FileError
from fairyring.model.json_files import (
    BYTE_ORDER_MARK,
    JsonError,
    parse_json,
    parse_loosely,
    read_file,
    unzipped,
)

Item = Any
"""A value that JSON can hold: as text (``Raw``), or decoded already."""


class FormatError(FairyringError):
    """What is no COCO document; the sentence does not name the file."""


class Document(Struct, frozen=True, kw_only=True):
    """The items of a COCO document or a list of results, none of them checked yet."""

    images: Sequence[Item] | None
    """Items of the images; None for a list of results."""
    annotations: Sequence[Item]
    others: dict[str, Any]
    """All other keys of the document, decoded."""


class _Belonging(Struct):
    image_id: Any = None


_TOP = msgspec.json.Decoder(dict[str, Raw] | list[Raw])
_ITEMS = msgspec.json.Decoder(list[Raw])
_ITEM = msgspec.json.Decoder()
_BELONGING = msgspec.json.Decoder(_Belonging)


def read_document(path: Path) -> Document:
    """The document in a file, gzipped or not. Raises FileError, which names the file."""
    data = read_file(path)
    try:
        return parse_document(data)
    except FairyringError as error:
        raise FileError(f"{path}: {error}") from error


def parse_document(data: bytes) -> Document:
    """The document in the bytes of a file, gzipped or not.

    Raises:
        JsonError: they are no JSON.
        FormatError: it is neither a COCO document nor a list.
    """
    text = unzipped(data).removeprefix(BYTE_ORDER_MARK)
    try:
        top = _TOP.decode(text)
    except msgspec.ValidationError:
        return document_of(parse_json(text))
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        # Perhaps NaN, half a character or another encoding, which the slower parser knows.
        return document_of(parse_loosely(text))
    if isinstance(top, list):
        return document_of(top)
    return document_of(
        {key: _items(raw) if key in ("images", "annotations") else value_of(raw) for key, raw in top.items()}
    )


def document_of(value: Any) -> Document:
    """A document that is decoded already, or its items still text. Raises FormatError."""
    if isinstance(value, list):
        return Document(images=None, annotations=value, others={})
    if not isinstance(value, dict) or not isinstance(value.get("images"), list):
        raise FormatError("This is neither a COCO file with a list of images nor a list of results.")
    annotations = value.get("annotations")
    if annotations is not None and not isinstance(annotations, list):
        raise FormatError("This is not a COCO file: its annotations are not a list.")
    others = {key: other for key, other in value.items() if key not in ("images", "annotations")}
    return Document(images=value["images"], annotations=annotations or [], others=others)


def value_of(item: Item) -> Any:
    """The decoded value of an item. Raises JsonError."""
    if type(item) is not Raw:
        return item
    try:
        return _ITEM.decode(item)
    except (msgspec.MsgspecError, UnicodeDecodeError):
        # A number that no float holds, for example.
        return parse_loosely(bytes(item))


def objects_of(
    kind: str, items: Sequence[Item], *, report: Report, indices: Iterable[int] | None = None
) -> Iterator[tuple[int, str, dict[str, Any]]]:
    """Index, place and keys of the items (at ``indices``); ``report`` hears of those that are no objects."""
    for index in range(len(items)) if indices is None else indices:
        try:
            entry = value_of(items[index])
        except JsonError as error:
            report(Fault(place_of(kind, None, index), str(error)))
            continue
        if isinstance(entry, dict):
            yield index, place_of(kind, entry, index), entry
        else:
            report(Fault(place_of(kind, None, index), "It is not an object."))


def annotations_by_image(document: Document) -> dict[Id | None, list[int]]:
    """Indices of the annotations, in their order, by the image they say they belong to; None for no image."""
    groups: dict[Id | None, list[int]] = defaultdict(list)
    for index, item in enumerate(document.annotations):
        groups[_image_of(item)].append(index)
    return groups


def _image_of(item: Item) -> Id | None:
    if type(item) is not Raw:
        return id_of(item.get("image_id")) if isinstance(item, dict) else None
    try:
        return id_of(_BELONGING.decode(item).image_id)
    except (msgspec.MsgspecError, UnicodeDecodeError):
        return None


def _items(raw: Raw) -> Any:
    try:
        return _ITEMS.decode(raw)
    except msgspec.ValidationError:
        return value_of(raw)
