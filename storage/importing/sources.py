"""Finds the files of an import: the paths that a person named, and the files in folders among them."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from hashlib import sha256
from pathlib import Path

from msgspec import Struct, field

from fairyring.model.coco.document import FormatError
from fairyring.model.errors import FairyringError
from fairyring.model.json_files import unzipped
from fairyring.model.photo import SUFFIXES
from fairyring.storage.choices import ImportFormat, Polygons
from fairyring.storage.errors import StoreError
from fairyring.storage.formats.coco import parse_coco
from fairyring.storage.formats.found import Found, Problem
from fairyring.storage.formats.labelme import parse_labelme
from fairyring.storage.importing.other_kinds import (
    ARCHIVE,
    BY_SUFFIX,
    MASKS,
    OtherKind,
    is_picture_of_masks,
    other_kind_of,
    other_kind_of_json,
)

LABEL_SUFFIXES = (".json", ".json.gz")
LITTER = {".DS_Store", "Thumbs.db", "desktop.ini"}
"""Files that desktops leave in every folder."""


class Document(Struct, frozen=True, kw_only=True):
    """A file of labels that could be read."""

    path: Path
    sha256: str
    found: Found


class Sources(Struct, frozen=True, kw_only=True):
    """The files to import."""

    photos: list[Path] = field(default_factory=list)
    documents: list[Document] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)
    named: list[Path] = field(default_factory=list)
    """What a person named."""
    unreadable: list[str] = field(default_factory=list)
    """Files of labels that cannot be read, or are of a kind that is not."""


def gather(paths: Sequence[Path], *, kind: ImportFormat, polygons: Polygons = Polygons.visible) -> Sources:
    """Reads the label files and lists the photos.

    Folders are searched to the bottom, in the order of names. What is passed over there is among the
    problems: hidden files, symbolic links, which could lead anywhere, and what is neither a photo nor a file
    of labels by its name.

    Raises:
        StoreError: a path does not exist, or is an archive.
    """
    sources = Sources(named=list(paths))
    for path in paths:
        if BY_SUFFIX.get(path.suffix.lower()) is ARCHIVE and not _holds_labels(path):
            raise StoreError(f"{path} is an archive; unpack it and import the folder.")
        if path.is_dir():
            for file in _files_below(path, sources.problems):
                _take(file, sources, kind=kind, polygons=polygons, named=False)
        elif path.exists():
            _take(path, sources, kind=kind, polygons=polygons, named=True)
        else:
            raise StoreError(f"{path} does not exist; check the path.")
    return sources


def _files_below(folder: Path, problems: list[Problem]) -> Iterator[Path]:
    """Yields the files in a folder and below; adds what is passed over to the problems."""

    def unreadable(error: OSError) -> None:
        problems.append(Problem(str(error.filename), "", f"It was passed over: {error.strerror}."))

    for parent, folders, files in os.walk(folder, onerror=unreadable):
        within: list[str] = []
        for name in sorted(folders + files):
            path = Path(parent) / name
            if (reason := _reason_to_pass_over(path)) is not None:
                problems.append(Problem(str(path), "", f"It was passed over: {reason}."))
            elif name in folders:
                within.append(name)
            elif name not in LITTER:
                yield path
        folders[:] = within


def _reason_to_pass_over(path: Path) -> str | None:
    if path.name in LITTER:
        return None
    if path.is_symlink():
        return "it is a symbolic link; import what it points to"
    if path.name.startswith("."):
        return "it is hidden; rename it to import it"
    return None


def _take(file: Path, sources: Sources, *, kind: ImportFormat, polygons: Polygons, named: bool) -> None:
    is_document = _holds_labels(file) or (named and kind in (ImportFormat.coco, ImportFormat.labelme))
    is_photo = named or file.suffix.lower() in SUFFIXES
    other = None if is_document or (named and kind is not ImportFormat.auto) else _other_kind_of(file)
    if is_document and kind != ImportFormat.images:
        _read(file, sources, kind=kind, polygons=polygons, named=named)
    elif other is not None:
        sources.problems.append(Problem(str(file), "", f"It was passed over: it is {other}."))
        sources.unreadable.extend([str(file)] if other.has_labels else [])
    elif is_photo and kind in (ImportFormat.auto, ImportFormat.images):
        sources.photos.append(file)
    elif named:
        sources.problems.append(Problem(str(file), "", f"This is no file of the format {kind}."))
    elif not is_document and not is_photo:
        reason = "It was passed over: by its name it is neither a photo nor a file of labels."
        sources.problems.append(Problem(str(file), "", reason))


def _other_kind_of(file: Path) -> OtherKind | None:
    """What a file is that is known and not read."""
    if file.suffix.lower() in SUFFIXES:
        return MASKS if is_picture_of_masks(file) else None
    try:
        return other_kind_of(file)
    except OSError:
        return None


def _holds_labels(file: Path) -> bool:
    return file.name.lower().endswith(LABEL_SUFFIXES)


def _read(file: Path, sources: Sources, *, kind: ImportFormat, polygons: Polygons, named: bool) -> None:
    try:
        data = file.read_bytes()
        text = unzipped(data)
    except OSError as error:
        _cannot_be_read(file, f"It cannot be read: {error.strerror}.", sources)
        return
    except FairyringError as error:
        _cannot_be_read(file, str(error), sources)
        return
    try:
        found = _parse(text, file=str(file), kind=kind, polygons=polygons)
        sources.documents.append(Document(path=file, sha256=sha256(data).hexdigest(), found=found))
    except FormatError as error:
        other = other_kind_of_json(text)
        if other is None and not named and b'"annotations"' not in text:
            reason = "It was passed over: there are no labels in it that could be read."
            sources.problems.append(Problem(str(file), "", reason))
        else:
            _cannot_be_read(file, str(error) if other is None else f"This is {other}.", sources)
    except FairyringError as error:
        _cannot_be_read(file, str(error), sources)


def _cannot_be_read(file: Path, reason: str, sources: Sources) -> None:
    sources.problems.append(Problem(str(file), "", reason))
    sources.unreadable.append(str(file))


def _parse(data: bytes, *, file: str, kind: ImportFormat, polygons: Polygons) -> Found:
    if kind == ImportFormat.labelme or (kind == ImportFormat.auto and _looks_like_labelme(data)):
        return parse_labelme(data, file=file, polygons=polygons)
    return parse_coco(data, file=file)


def _looks_like_labelme(data: bytes) -> bool:
    """Guesses the format: labelme files have shapes, COCO files have annotations."""
    return b'"shapes"' in data and b'"annotations"' not in data
