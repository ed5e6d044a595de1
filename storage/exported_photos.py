"""Writes photos into an export: as they are, or upright where EXIF turns them; or links to them."""

from __future__ import annotations

import shutil
from hashlib import sha256
from pathlib import Path

import cv2

from fairyring.model.photo import probe, read
from fairyring.model.progress import Progress, silent
from fairyring.storage.choices import ExportedPhotos
from fairyring.storage.errors import StoreError
from fairyring.storage.originals import PhotoChangedError, PhotoGoneError
from fairyring.storage.project import Project
from fairyring.storage.records import Image

JPEG_QUALITY = 97
JPEG = (".jpg", ".jpeg", ".jpe")
"""Endings of files that OpenCV writes as JPEG; in other formats it complains of a quality."""


def write_photos(
    project: Project,
    images: list[Image],
    folder: Path,
    *,
    photos: ExportedPhotos = ExportedPhotos.copied,
    skip_missing: bool = False,
    progress: Progress = silent,
) -> tuple[dict[int, str], list[str]]:
    """The SHA-256 of each photo as it was written, by its image; and a sentence about each other one.

    ``skip_missing`` leaves out images whose photo is gone. Raises StoreError where one is gone otherwise.
    """
    if photos is ExportedPhotos.none:
        return {image.id: image.sha256 for image in images}, []
    folder.mkdir()
    copied: dict[int, str] = {}
    left_out: list[str] = []
    for done, image in enumerate(images):
        progress(done, len(images), "Copying photos")
        try:
            target = folder / image.file_name
            target.parent.mkdir(parents=True, exist_ok=True)
            source = project.originals.path_of(image)
            if photos is ExportedPhotos.linked and probe(source).orientation == 1:
                target.symlink_to(source.resolve())
                copied[image.id] = image.sha256
            else:
                copied[image.id] = _copy(source, target, image.sha256)
        except PhotoChangedError as error:
            left_out.append(str(error))
        except PhotoGoneError as error:
            if not skip_missing:
                raise StoreError(f"{error} Or leave out such images: --skip-missing.") from error
            left_out.append(str(error))
    return copied, left_out


def _copy(source: Path, target: Path, digest: str) -> str:
    """Copies a photo of this SHA-256, and returns that of the copy."""
    if probe(source).orientation == 1:
        shutil.copyfile(source, target)
        return digest
    # OpenCV goes by the ending, and does not know all of JPEG's.
    suffix = target.suffix.lower().replace(".jfif", ".jpg") or ".png"
    quality = [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY] if suffix in JPEG else []
    _, encoded = cv2.imencode(suffix, read(source), quality)
    upright = encoded.tobytes()
    target.write_bytes(upright)
    return sha256(upright).hexdigest()
