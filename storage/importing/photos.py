"""Photos on their way into a project: found, examined, copied into a temporary folder, then moved in."""

from __future__ import annotations

import filecmp
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from uuid import uuid4

from msgspec import Struct, field
from sqlalchemy import Connection, select

from fairyring.model.json_values import base_name
from fairyring.model.photo import probe
from fairyring.storage.db import schema
from fairyring.storage.errors import StoreError

INCOMING = ".incoming"


class Photo(Struct, frozen=True, kw_only=True):
    """An image of the project, or one that is about to become one."""

    file_name: str
    width: int
    height: int
    sha256: str
    id: int | None = None
    """None until it is in the project."""
    source: Path | None = None
    """Path of a new photo; None for one of the project."""
    light: str | None = None
    form: str | None = None
    split: str | None = None
    extra: dict[str, Any] = field(default_factory=dict)


def photos_of_project(connection: Connection) -> dict[str, Photo]:
    """The photos of the project, by base name."""
    columns = [schema.image.c[name] for name in Photo.__struct_fields__ if name != "source"]
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


def find_beside(document: Path, name: str) -> Path | None:
    """The photo of this base name beside a label file, or in ``images/`` beside it.

    Raises:
        StoreError: it is a symbolic link, which could lead anywhere.
    """
    for candidate in (document.parent / name, document.parent / "images" / name):
        if candidate.is_symlink():
            raise StoreError(f"{candidate} is a symbolic link; import the file it points to first.")
        if candidate.is_file():
            return candidate
    return None


class Staging:
    """Copies made for one import; if it fails they are removed again."""

    def __init__(self, images: Path) -> None:
        self._images = images
        self._folder = images / f"{INCOMING}-{uuid4().hex}"
        self._moved_in: list[Path] = []

    def copy(self, photo: Photo) -> None:
        """Copies a new photo into the temporary folder and syncs it; one already in ``images/`` stays.

        Raises:
            StoreError: it cannot be read or written, or another file is in its way.
        """
        source, target = _source_of(photo), self._images / photo.file_name
        if target.exists() and not filecmp.cmp(source, target, shallow=False):
            raise StoreError(f"{target} is in the way of {source} and not part of the project; move it away.")
        if target.exists():
            return
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, self._folder / photo.file_name)
            _sync(self._folder / photo.file_name)
        except OSError as error:
            raise StoreError(f"{source} cannot be copied into the project: {error.strerror}.") from error

    def move_in(self) -> None:
        """Gives all copies their names in ``images/``; done just before the rows are committed."""
        if not self._folder.exists():
            return
        for copy in sorted(self._folder.iterdir()):
            target = self._images / copy.name
            copy.replace(target)
            self._moved_in.append(target)
        _sync(self._images)

    def undo(self) -> None:
        """Removes what was moved in: its rows were not committed."""
        for target in self._moved_in:
            target.unlink(missing_ok=True)
        self._moved_in.clear()

    def clear(self) -> None:
        """Removes the temporary folder."""
        shutil.rmtree(self._folder, ignore_errors=True)


@contextmanager
def staging(images: Path) -> Iterator[Staging]:
    """A ``Staging`` that cleans up after itself, whatever happens."""
    copies = Staging(images)
    try:
        yield copies
    except BaseException:
        copies.undo()
        raise
    finally:
        copies.clear()


def _source_of(photo: Photo) -> Path:
    assert photo.source is not None, "only new photos are copied"
    return photo.source


def _sync(path: Path) -> None:
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
