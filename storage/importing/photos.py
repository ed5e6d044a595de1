"""Photos of a project, and those about to become some: found and examined."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from unicodedata import normalize

from msgspec import Struct, field
from sqlalchemy import Connection, select

from fairyring.model.coco.photo_names import PhotoNames
from fairyring.model.json_values import base_name
from fairyring.model.photo import SUFFIXES, probe
from fairyring.storage.db import schema
from fairyring.storage.errors import StoreError
from fairyring.storage.records import Status


class Photo(Struct, frozen=True, kw_only=True):
    """An image of the project, or one that is about to become one."""

    file_name: str
    width: int
    height: int
    sha256: str
    id: int | None = None
    """None until it is in the project."""
    number: int | None = None
    """The id that a file of labels calls a new one by."""
    source: Path | None = None
    """Path of a new photo; None for one of the project."""
    light: str | None = None
    form: str | None = None
    split: str | None = None
    status: Status | None = None
    """None where nobody has said anything of a new photo."""
    extra: dict[str, Any] = field(default_factory=dict)


def photos_of_project(connection: Connection) -> dict[str, Photo]:
    """The photos of the project, by base name."""
    columns = [schema.image.c[name] for name in Photo.__struct_fields__ if name not in ("source", "number")]
    return {row["file_name"]: Photo(**row) for row in connection.execute(select(*columns)).mappings()}


def examine(path: Path) -> Photo:
    """Reads and checks a photo file.

    Raises:
        PhotoError: it cannot be read as an image.
        ValueRefusedError: its name cannot be kept.
    """
    info = probe(path)
    return Photo(
        file_name=base_name(path.name),
        width=info.width,
        height=info.height,
        sha256=info.sha256,
        source=path,
    )


class Beside:
    """The photos beside a label file, and in ``images/`` beside it."""

    def __init__(self, document: Path) -> None:
        self.names = PhotoNames()
        self._paths: dict[str, Path] = {}
        for folder in (document.parent, document.parent / "images"):
            for file in sorted(folder.iterdir()) if folder.is_dir() else ():
                if file.suffix.lower() in SUFFIXES and file.is_file():
                    self.names.add(file.name)
                    self._paths.setdefault(normalize("NFC", file.name), file)

    def path_of(self, name: str) -> Path | None:
        """The photo of this name.

        Raises:
            StoreError: it or ``images/`` is a symbolic link, which could lead anywhere.
        """
        path = self._paths.get(name)
        if path is None:
            return None
        for link in (path, path.parent if path.parent.name == "images" else path):
            if link.is_symlink():
                raise StoreError(f"{link} is a symbolic link; import what it points to first.")
        return path
