"""Photos on their way into ``images/``: copied into a temporary folder, then given their names there."""

from __future__ import annotations

import filecmp
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from sqlalchemy import select

from fairyring.storage.db import schema
from fairyring.storage.errors import StoreError
from fairyring.storage.importing.photos import Photo
from fairyring.storage.project import Project
from fairyring.storage.whole_folders import leftovers_in, sync, temporary_folder


class Staging:
    """Copies made for one import; if it fails they are removed again."""

    def __init__(self, images: Path, folder: Path) -> None:
        self._images = images
        self._folder = folder
        self._moved_in: list[Path] = []

    def copy(self, photo: Photo) -> None:
        """Copies a new photo into the temporary folder and syncs it; one already in ``images/`` stays.

        Raises:
            StoreError: it cannot be read or written, or another file is in its way.
        """
        assert photo.source is not None, "only new photos are copied"
        target = self._images / photo.file_name
        if target.exists():
            if not filecmp.cmp(photo.source, target, shallow=False):
                raise StoreError(
                    f"{target} is in the way of {photo.source} and not part of the project; move it away."
                )
            return
        try:
            copy = self._folder / photo.file_name
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(photo.source, copy)
            sync(copy)
        except OSError as error:
            raise StoreError(
                f"{photo.source} cannot be copied into the project: {error.strerror}."
            ) from error

    def move_in(self) -> None:
        """Gives all copies their names in ``images/``; done just before the rows are committed.

        In the temporary folder they stay until that is done: a later import knows by them what a killed one
        moved in.
        """
        for copy in _files_below(self._folder):
            target = self._images / copy.relative_to(self._folder)
            target.parent.mkdir(parents=True, exist_ok=True)
            try:
                os.link(copy, target)
            except FileExistsError as error:
                raise StoreError(f"{target} was written just now by somebody else; import again.") from error
            except OSError:
                copy.replace(target)  # a drive without links
            self._moved_in.append(target)
        for folder in {self._images, *(target.parent for target in self._moved_in)}:
            sync(folder)

    def undo(self) -> None:
        """Removes what was moved in: its rows were not committed."""
        for target in self._moved_in:
            _remove(target, within=self._images)
        self._moved_in.clear()


@contextmanager
def staging(project: Project) -> Iterator[Staging]:
    """A ``Staging`` that cleans up after itself, whatever happens, and first after imports that were killed.

    Raises:
        StoreError: ``images/`` cannot be written.
    """
    clear_killed_imports(project)
    try:
        project.images.mkdir(exist_ok=True)
        with temporary_folder(project.images) as folder:
            copies = Staging(project.images, folder)
            try:
                yield copies
            except BaseException:
                copies.undo()
                raise
    except OSError as error:
        raise StoreError(f"{project.images} cannot be written: {error.strerror}.") from error


def clear_killed_imports(project: Project) -> None:
    """Removes the copies of imports that were killed, and what they had moved in without entering it."""
    if project.read_only:
        return
    for folder in leftovers_in(project.images):
        with project.read() as connection:
            entered = set(connection.execute(select(schema.image.c.file_name)).scalars())
        for copy in _files_below(folder):
            name = copy.relative_to(folder)
            target = project.images / name
            if name.as_posix() not in entered and target.exists() and target.samefile(copy):
                _remove(target, within=project.images)


def _files_below(folder: Path) -> list[Path]:
    return sorted(path for path in folder.rglob("*") if path.is_file())


def _remove(photo: Path, *, within: Path) -> None:
    """Removes a photo, and the folders for it that are empty then."""
    photo.unlink(missing_ok=True)
    for folder in photo.parents:
        if folder == within or not folder.is_dir() or any(folder.iterdir()):
            return
        folder.rmdir()
