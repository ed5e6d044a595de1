"""Checks that a photo on disk is still the one that was imported: its labels hold for no other."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

from fairyring.storage.errors import StoreError
from fairyring.storage.records import Image


class PhotoGoneError(StoreError):
    """There is no file, or none that can be opened."""


class PhotoChangedError(StoreError):
    """There is a file, and it is not the photo that was imported."""


class Originals:
    """The photos of a project. Each is read once, and again when its file was written or replaced."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._digests: dict[Path, tuple[tuple[int, ...], str]] = {}

    def path_of(self, image: Image) -> Path:
        """Where the photo lies. Safe from any thread.

        Raises:
            PhotoGoneError: it cannot be opened.
            PhotoChangedError: the file is another one.
        """
        path = self._folder / image.path
        try:
            digest = self._digest_of(path)
        except FileNotFoundError as error:
            raise PhotoGoneError(f"{path} is gone; put the photo back.") from error
        except OSError as error:
            raise PhotoGoneError(f"{path} cannot be opened ({error.strerror}); put that right.") from error
        if digest != image.sha256:
            raise PhotoChangedError(f"{path} is no longer the photo that was imported; put that back.")
        return path

    def _digest_of(self, path: Path) -> str:
        with path.open("rb") as file:
            stat = os.fstat(file.fileno())
            # A copy may keep the time of writing and the size, but not these as well.
            stamp = (stat.st_mtime_ns, stat.st_ctime_ns, stat.st_size, stat.st_ino)
            known = self._digests.get(path)
            if known is not None and known[0] == stamp:
                return known[1]
            digest = hashlib.file_digest(file, "sha256").hexdigest()
        self._digests[path] = stamp, digest
        return digest


def digest_of_file(path: Path) -> str:
    """SHA-256 of a file's bytes. Raises StoreError where it cannot be read."""
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise StoreError(f"{path} cannot be read: {error.strerror}.") from error
