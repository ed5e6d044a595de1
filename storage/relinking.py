"""Finds photos of a project that are gone from their place, and has the project look where they lie now."""

from __future__ import annotations

import os
import shutil
from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath

from msgspec import Struct
from sqlalchemy import Connection, update

from fairyring.model.photo import SUFFIXES
from fairyring.model.progress import Progress, silent
from fairyring.storage.db import schema
from fairyring.storage.errors import StoreError
from fairyring.storage.folder import IMAGES
from fairyring.storage.images import ImageFilter, get_image, list_ids
from fairyring.storage.originals import PhotoChangedError, PhotoGoneError, digest_of_file
from fairyring.storage.project import Project
from fairyring.storage.records import Image


class Relinked(Struct, frozen=True, kw_only=True):
    """What was looked for."""

    found: dict[str, Path]
    """Where photos lie, by the names of their images."""
    missing: list[str]
    """Names of images whose photos are in none of the folders."""


def missing_photos(project: Project) -> list[Image]:
    """The images whose file is gone, or is no longer the photo that was imported."""
    with project.read() as connection:
        images = [get_image(connection, number) for number in list_ids(connection, ImageFilter())]
    return [image for image in images if not _is_there(project, image)]


def relink(project: Project, folders: Sequence[Path], *, progress: Progress = silent) -> Relinked:
    """Looks for missing photos in folders and below them: by name first, then whatever they are called.

    Only the same bytes are the same photo. Linked images point to it then; copied ones are copied again.

    Raises:
        StoreError: a folder does not exist, or the project cannot be written to.
    """
    project.require_writable()
    for folder in folders:
        if not folder.is_dir():
            raise StoreError(f"{folder} is not a folder; name one to look for photos in.")
    gone = missing_photos(project)
    found = _find(gone, [file for folder in folders for file in _photos_below(folder)], progress)
    for image in gone:
        if image.id in found and image.path.startswith(f"{IMAGES}/"):
            _copy(found[image.id], project.folder / image.path)

    def point(connection: Connection) -> None:
        for image in gone:
            if image.id in found and not image.path.startswith(f"{IMAGES}/"):
                place = str(found[image.id].resolve())
                connection.execute(
                    update(schema.image).where(schema.image.c.id == image.id).values(path=place)
                )

    project.write(point)
    return Relinked(
        found={image.file_name: found[image.id] for image in gone if image.id in found},
        missing=[image.file_name for image in gone if image.id not in found],
    )


def _is_there(project: Project, image: Image) -> bool:
    try:
        project.originals.path_of(image)
    except (PhotoGoneError, PhotoChangedError):
        return False
    return True


def _find(gone: Sequence[Image], files: Sequence[Path], progress: Progress) -> dict[int, Path]:
    """Where photos lie, by the numbers of their images."""
    wanted = {image.sha256: image for image in gone}
    names = {PurePosixPath(image.file_name).name.casefold() for image in gone}
    likely_first = sorted(files, key=lambda file: file.name.casefold() not in names)
    places: defaultdict[str, list[Path]] = defaultdict(list)
    for done, file in enumerate(likely_first):
        if wanted.keys() <= places.keys():
            break
        progress(done, len(likely_first), "Looking for photos")
        places[digest_of_file(file)].append(file)
    return {image.id: places[image.sha256][0] for image in gone if places.get(image.sha256)}


def _photos_below(folder: Path) -> Iterator[Path]:
    for parent, folders, files in os.walk(folder):
        folders.sort()
        yield from (
            Path(parent) / name
            for name in sorted(files)
            if Path(name).suffix.lower() in SUFFIXES and not name.startswith(".")
        )


def _copy(source: Path, target: Path) -> None:
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, target)
    except OSError as error:
        raise StoreError(f"{source} cannot be copied to {target}: {error.strerror}.") from error
