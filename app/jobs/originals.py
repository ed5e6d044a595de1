"""Checks that a photo on disk is still the one that was imported: coordinates hold for no other."""

from __future__ import annotations

import hashlib
from pathlib import Path

from fairyring.model.errors import FairyringError
from fairyring.storage.project import Project
from fairyring.storage.records import Image


def original_of(project: Project, image: Image) -> Path:
    """Path of a project's photo. Raises FairyringError where it is gone or has been changed."""
    path = project.folder / image.path
    try:
        with path.open("rb") as file:
            digest = hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise FairyringError(f"{path} cannot be opened ({error.strerror}); put the photo back.") from error
    if digest != image.sha256:
        raise FairyringError(f"{path} is no longer the photo that was imported; put that back.")
    return path
