"""Photos that lie within files of labels, as labelme writes them when it is told to."""

from __future__ import annotations

import base64
import binascii
from pathlib import Path

from msgspec import structs

from fairyring.model.json_files import parse_json, read_file, unzipped
from fairyring.model.photo import PhotoError
from fairyring.storage.errors import StoreError
from fairyring.storage.importing.photos import Photo, examine


def unpacked_photo(document: Path, name: str, *, scratch: Path) -> Photo:
    """The photo in a labelme file, written below ``scratch`` in folders called as those of the file.

    It is read from the file again: all of a folder's photos at once would not fit into memory.

    Raises:
        FairyringError: it cannot be read as a photo.
    """
    text = parse_json(unzipped(read_file(document))).get("imageData")
    try:
        data = base64.b64decode(text)
    except (TypeError, ValueError, binascii.Error) as error:
        raise StoreError(f"{name} is not beside this file, and the imageData in it is damaged.") from error
    folder = scratch.joinpath(*document.absolute().parts[1:-1])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(data)
    try:
        photo = examine(folder / name)
    except PhotoError as error:
        raise StoreError(f"{name} is not beside this file, and the imageData in it is no photo.") from error
    return structs.replace(photo, within_labels=True)
