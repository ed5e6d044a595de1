"""The first half of an import: everything is read and checked, and nothing is changed yet."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from msgspec import Struct, field, structs

from fairyring.model.coco.photo_names import PhotoNames, meant
from fairyring.model.errors import FairyringError
from fairyring.model.json_values import base_name
from fairyring.model.progress import Progress
from fairyring.storage.errors import StoreError
from fairyring.storage.formats.found import FoundCap, FoundImage, Problem
from fairyring.storage.importing.cap_checks import check_caps
from fairyring.storage.importing.photos import Beside, Photo, examine
from fairyring.storage.importing.sources import Document, Sources
from fairyring.storage.records import Status


class Facts(Struct, frozen=True, kw_only=True):
    """What a person says of photos whose file says nothing of it."""

    light: str | None = None
    form: str | None = None
    status: Status | None = None
    """Of photos with labels."""


NOTHING_SAID = Facts()


class Intake(Struct, kw_only=True):
    """What an import has read and checked: what can be stored, and the problems."""

    photos: dict[str, Photo]
    """Photos of the project and new ones, by base name."""
    seen: set[str] = field(default_factory=set)
    """Base names of the photos that this import is about."""
    caps: dict[str, list[FoundCap]] = field(default_factory=dict)
    """Caps checked against their photo, by its name."""
    problems: list[Problem] = field(default_factory=list)
    names: PhotoNames = field(default_factory=PhotoNames)
    """Of the photos."""
    _beside: dict[Path, Beside] = field(default_factory=dict)
    """By the folder of the label file."""

    def __post_init__(self) -> None:
        for name in self.photos:
            self.names.add(name)

    def beside_of(self, document: Path) -> Beside:
        """What lies beside a label file; its folder is listed once."""
        if document.parent not in self._beside:
            self._beside[document.parent] = Beside(document)
        return self._beside[document.parent]

    @property
    def new_photos(self) -> list[Photo]:
        """The photos that the project lacks, in the order of the import."""
        return [photo for photo in self.photos.values() if photo.id is None]


def take_in(
    sources: Sources, *, known: dict[str, Photo], unsaid: Facts = NOTHING_SAID, progress: Progress
) -> Intake:
    """Checks every photo, and every cap against its photo.

    Args:
        sources: what was gathered.
        known: the photos of the project.
        unsaid: what holds of photos where their file does not say otherwise.
        progress: called once a photo.
    """
    intake = Intake(photos=dict(known), problems=list(sources.problems))
    tasks: list[tuple[str, str, Callable[[], None]]] = [
        (str(path), "", lambda path=path: _take_photo(intake, path, unsaid)) for path in sources.photos
    ]
    for document in sources.documents:
        intake.problems.extend(document.found.problems)
        tasks += [
            (
                str(document.path),
                image.where,
                lambda document=document, image=image: _take_labels(intake, document, image, unsaid),
            )
            for image in document.found.images
        ]
    for done, (file, where, take) in enumerate(tasks):
        progress(done, len(tasks), "Checking")
        try:
            take()
        except FairyringError as error:
            intake.problems.append(Problem(file, where, str(error).removeprefix(f"{file}: ")))
    return intake


def _take_photo(intake: Intake, path: Path, unsaid: Facts) -> None:
    _add(intake, structs.replace(examine(path), light=unsaid.light, form=unsaid.form))


def _add(intake: Intake, photo: Photo) -> Photo:
    other = intake.photos.get(photo.file_name)
    if other is not None and other.sha256 != photo.sha256:
        raise StoreError(f"Another image is called {photo.file_name} already; rename one of them.")
    intake.seen.add(photo.file_name)
    intake.names.add(photo.file_name)
    return intake.photos.setdefault(photo.file_name, photo)


def _take_labels(intake: Intake, document: Document, image: FoundImage, unsaid: Facts) -> None:
    photo = _photo_of(intake, document.path, image)
    intake.photos[photo.file_name] = _told_more(photo, image, unsaid)
    intake.seen.add(photo.file_name)
    caps, problems = check_caps(image.caps, photo=photo, file=str(document.path))
    intake.caps.setdefault(photo.file_name, []).extend(caps)
    intake.problems.extend(problems)


def _told_more(photo: Photo, image: FoundImage, unsaid: Facts) -> Photo:
    """The photo with what a file says of it; an import changes nothing that the project knows already."""
    said = image.status or unsaid.status
    status = said if photo.status in (None, "new") else photo.status
    if photo.id is None:
        return structs.replace(
            photo,
            number=photo.number or image.id,
            light=image.light or photo.light or unsaid.light,
            form=image.form or photo.form or unsaid.form,
            split=image.split or photo.split,
            status=status,
            extra=photo.extra | image.extra,
        )
    return structs.replace(
        photo,
        light=photo.light or image.light,
        form=photo.form or image.form,
        split=photo.split or image.split,
        status=status or photo.status,
        extra=image.extra | photo.extra,
    )


def _photo_of(intake: Intake, document: Path, image: FoundImage) -> Photo:
    """The photo of an image: in the project by base name and size, beside the file, or in ``images/``."""
    name = base_name(image.file_name)
    near = intake.beside_of(document)
    found_name = meant(name, intake.names, near.names) or name
    photo = intake.photos.get(found_name)
    if photo is not None and _has_size(photo, image):
        return photo
    beside = near.path_of(found_name)
    if beside is not None:
        found = examine(beside)
        if _has_size(found, image):
            return _add(intake, found)
    if beside is None and photo is None:
        other = intake.names.suggest(name) or near.names.suggest(name)
        question = f"; if {other} is meant, call it that in this file" if other else ""
        raise StoreError(
            f"{name} is neither in the project nor beside this file nor in images/ beside it{question}."
        )
    actual = photo or examine(beside) if beside else photo
    assert actual is not None, "one of the two was found"
    raise StoreError(
        f"{name} is {actual.width} × {actual.height} pixels when upright, "
        f"but this file says {image.width} × {image.height}."
    )


def _has_size(photo: Photo, image: FoundImage) -> bool:
    return image.width in (None, photo.width) and image.height in (None, photo.height)
