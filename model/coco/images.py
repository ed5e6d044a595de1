"""The images of a COCO document."""

from __future__ import annotations

from typing import Any
from unicodedata import normalize

from msgspec import Struct

from fairyring.model.coco.document import Document, objects_of
from fairyring.model.coco.faults import Report, Reported
from fairyring.model.coco.ids import Id, id_of
from fairyring.model.json_values import ValueRefusedError, base_name, size


class ImageEntry(Struct, frozen=True, kw_only=True):
    """One image, its keys otherwise unread."""

    id: Id
    where: str
    """The name that a ``Fault`` gives it."""
    width: int | None
    """Width in pixels; None where the file does not say."""
    height: int | None
    keys: dict[str, Any]
    """All keys, as the file has them."""


def read_images(document: Document, *, report: Report) -> dict[Id, ImageEntry]:
    """The images by id; of several with one id the first. ``report`` hears of those that make no sense."""
    images: dict[Id, ImageEntry] = {}
    for _, where, entry in objects_of("image", document.images or (), report=report):
        with Reported(where, report):
            image = _read(entry, where)
            if image.id in images:
                raise ValueRefusedError("Another image has this id; only the first is taken.")
            images[image.id] = image
    return images


def by_path(images: dict[Id, ImageEntry], *, report: Report) -> dict[str, ImageEntry]:
    """The images by the path the file writes; of several of one the first. ``report`` hears of the others."""
    written: dict[str, ImageEntry] = {}
    for image in images.values():
        with Reported(image.where, report):
            name = base_name(image.keys.get("file_name"))
            path = normalize("NFC", image.keys["file_name"].replace("\\", "/")).removeprefix("./")
            if path in written:
                raise ValueRefusedError(f"Another image of this file is called {name} too; rename one.")
            written[path] = image
    return written


def size_of(image: ImageEntry) -> tuple[int, int]:
    """Width and height of an image, pixels. Raises ValueRefusedError where the file lacks one."""
    if image.width is None or image.height is None:
        raise ValueRefusedError("The file does not say how wide and high it is.")
    return image.width, image.height


def _read(entry: dict[str, Any], where: str) -> ImageEntry:
    own = id_of(entry.get("id"))
    if own is None:
        raise ValueRefusedError("The id is missing or neither a whole number nor text.")
    return ImageEntry(
        id=own,
        where=where,
        width=size(entry.get("width"), "The width"),
        height=size(entry.get("height"), "The height"),
        keys=entry,
    )
