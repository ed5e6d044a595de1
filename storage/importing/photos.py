"""Photos of a project, and those about to become some: examined, compared, and given their names."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np
from msgspec import Struct, field, structs
from sqlalchemy import Connection, select

from fairyring.model.json_values import base_name
from fairyring.model.photo import PhotoError, probe, read
from fairyring.storage.db import schema
from fairyring.storage.errors import StoreError
from fairyring.storage.records import Status

COMPARED_AT = 256
"""Longest side of two photos that are compared, pixels: what a JPEG loses is averaged out there."""
MEAN_APART, MOST_APART = 1.5, 12
"""How far grey levels of one photo saved twice lie apart: on average, and in all but a thousandth of them."""


class Photo(Struct, frozen=True, kw_only=True):
    """An image of the project, or one that is about to become one."""

    file_name: str
    width: int
    height: int
    sha256: str
    id: int | None = None
    """None until it is in the project."""
    path: str | None = None
    """As the project keeps it; None for a new one."""
    number: int | None = None
    """The id that a file of labels calls a new one by."""
    source: Path | None = None
    """Path of a new photo; None for one of the project."""
    within_labels: bool = False
    """Whether a new one lay in a file of labels, so that ``source`` is gone after the import."""
    light: str | None = None
    form: str | None = None
    split: str | None = None
    status: Status | None = None
    """None where nobody has said anything of a new photo."""
    extra: dict[str, Any] = field(default_factory=dict)


_OF_NEW_ONES = ("source", "number", "within_labels")


def photos_of_project(connection: Connection) -> dict[str, Photo]:
    """The photos of the project, by name."""
    columns = [schema.image.c[name] for name in Photo.__struct_fields__ if name not in _OF_NEW_ONES]
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


def show_the_same(one: Path, other: Path) -> bool:
    """Whether two files are one photo that a program has saved anew; those of two moments are not."""
    try:
        pixels = [read(path, longest=COMPARED_AT).astype(np.int16) for path in (one, other)]
    except PhotoError:
        return False
    if pixels[0].shape != pixels[1].shape:
        return False
    apart = np.abs(pixels[0] - pixels[1])
    return float(apart.mean()) <= MEAN_APART and float(np.quantile(apart, 0.999)) <= MOST_APART


def named_apart(photos: Iterable[Photo]) -> list[Photo]:
    """The photos, new ones with the names they get: their base names, after folders where others have these.

    Raises ValueRefusedError where a folder's name cannot be kept.
    """
    photos = list(photos)
    alike: defaultdict[str, list[Photo]] = defaultdict(list)
    for photo in photos:
        alike[PurePosixPath(photo.file_name).name].append(photo)
    return [_named(photo, alike[PurePosixPath(photo.file_name).name]) for photo in photos]


def _named(photo: Photo, alike: Sequence[Photo]) -> Photo:
    if photo.id is not None or len(alike) == 1:
        return photo
    others = [other for other in alike if other is not photo]
    folders = folders_of(photo)
    for count in range(1, len(folders) + 1):
        name = _with_folders(photo.file_name, folders[-count:])
        if all(name != other.file_name and not _ends_in(other, folders[-count:]) for other in others):
            return structs.replace(photo, file_name=name)
    raise StoreError(f"Another image is called {photo.file_name} already; rename one of them.")


def folders_of(photo: Photo) -> tuple[str, ...]:
    """The folders above a photo: those it was found in, of one of the project those in its name."""
    if photo.source is None:
        return PurePosixPath(photo.file_name).parts[:-1]
    return photo.source.absolute().parts[1:-1]


def _ends_in(other: Photo, folders: Sequence[str]) -> bool:
    """Whether another new photo would get the same name from so many folders."""
    return other.id is None and folders_of(other)[-len(folders) :] == tuple(folders)


def _with_folders(name: str, folders: Sequence[str]) -> str:
    return "/".join([*(base_name(folder) for folder in folders), name])
