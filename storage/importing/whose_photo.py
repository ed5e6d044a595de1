"""Which photo an image of a file of labels is: of the project, lying around the file, or within it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from msgspec import Struct, field

from fairyring.model.coco.ids import Id
from fairyring.model.coco.photo_names import meant
from fairyring.model.json_values import base_name
from fairyring.model.photo import PhotoError
from fairyring.storage.errors import StoreError
from fairyring.storage.formats.found import FoundImage
from fairyring.storage.importing.around import Around
from fairyring.storage.importing.photo_index import PhotoIndex, has_size, other_size
from fairyring.storage.importing.photos import examine, folders_of
from fairyring.storage.importing.within_labels import unpacked_photo
from fairyring.storage.originals import digest_of_file


class PhotoSearch(Struct, kw_only=True):
    """Where photos are looked for that files of labels call by their names."""

    index: PhotoIndex
    """Photos of the project and of this import; what is found new is added."""
    named: list[Path]
    """Photos and folders that the import was given."""
    scratch: Path | None
    """A folder for photos that lie within files of labels; None leaves them there."""
    numbered: dict[int, set[int]] = field(default_factory=dict)
    """The photos by the numbers that the files give them, for lists of results."""
    around: dict[Path, Around] = field(default_factory=dict)
    """By file of labels."""


def photo_of(search: PhotoSearch, document: Path, image: FoundImage) -> int:
    """The number, in the index, of the photo that an image of a file is; StoreError if there is none.

    A photo lying around the file decides, where there is one: it is one that is known, or a new one. Else it
    is the one of that name and size, among several the one from the folders that the file names.
    """
    if image.called is not None:
        return _photo_of_results(search, image.called)
    index, name = search.index, base_name(image.file_name)
    if document not in search.around:
        search.around[document] = Around(document, search.named)
    near = search.around[document]
    called = meant(name, index.names, near.names) or name
    path = near.find(image.file_name, called=called)
    if path is not None and (nth := _lying_around(index, path, image)) is not None:
        _require_folder(image, path.absolute().parts[1:-1])
        return nth
    nth = index.meant_by(image, called)
    if nth is not None:
        _require_folder(image, folders_of(index.photos[nth]))
        return nth
    if image.has_photo and search.scratch is not None:
        return index.add(unpacked_photo(document, name, scratch=search.scratch))
    other = index.names.suggest(name) or near.names.suggest(name)
    question = f"; if {other} is meant, call it that in this file" if other else ""
    raise StoreError(
        f"{name} is neither in the project nor beside this file nor in images/ beside it{question}."
    )


def _require_folder(image: FoundImage, folders: Sequence[str]) -> None:
    """Raises StoreError where a file has a base name in several folders, and the photo is not from its."""
    written = image.file_name.split("/")[:-1]
    if image.one_of_several and written and (not folders or folders[-1] != written[-1]):
        raise StoreError(
            f"Several images of this file are called {base_name(image.file_name)}, and the photo that was "
            f"found is not from a folder {written[-1]}; put each photo into its folder."
        )


def _photo_of_results(search: PhotoSearch, called: Id) -> int:
    """The photo that a list of results calls by a number of another file or the project, or by its name."""
    listed = search.numbered.get(called, set()) if isinstance(called, int) else set()
    nth = next(iter(listed)) if len(listed) == 1 else search.index.numbered(called)
    if nth is None:
        raise StoreError(
            "No image of the project has this number, and no photo this name; import the list of results "
            "together with the COCO file that lists their images."
        )
    return nth


def _lying_around(index: PhotoIndex, path: Path, image: FoundImage) -> int | None:
    """The number of a photo beside a file of labels; None where another of its name is meant."""
    name = base_name(path.name)
    nth = index.with_content(name, digest_of_file(path)) if index.called(name) else None
    if nth is not None and has_size(index.photos[nth], image):
        return nth
    try:
        photo = examine(path)
    except PhotoError:
        if index.called(name):
            return None
        raise
    if has_size(photo, image):
        return index.add(photo)
    if index.called(name):
        return None
    raise other_size(photo, image)
