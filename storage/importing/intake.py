"""The first half of an import: everything is read and checked, and nothing is changed yet."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from msgspec import Struct, field, structs

from fairyring.model.errors import FairyringError
from fairyring.model.progress import Progress
from fairyring.storage.errors import StoreError
from fairyring.storage.formats.found import FoundCap, FoundImage, Problem
from fairyring.storage.importing.cap_checks import check_caps
from fairyring.storage.importing.copies import in_one_split
from fairyring.storage.importing.photo_index import PhotoIndex
from fairyring.storage.importing.photos import Photo, examine, named_apart
from fairyring.storage.importing.sources import Document, Sources
from fairyring.storage.importing.split_folders import SplitOf, folders_say_nothing, split_in_name
from fairyring.storage.importing.whose_photo import PhotoSearch, photo_of
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
    """Photos of the project and new ones, by name."""
    seen: set[str]
    """Names of the photos that this import is about."""
    caps: dict[str, list[FoundCap]]
    """Caps checked against their photo, by its name."""
    problems: list[Problem]
    copies: set[str] = field(default_factory=set)
    """Names of photos of the project that follow what is said of a copy of theirs."""
    useless: list[str] = field(default_factory=list)
    """Files of labels of which no label can be used."""
    told_otherwise: list[str] = field(default_factory=list)
    """Names of photos of the project of whose light, form or split files say something else."""

    @property
    def new_photos(self) -> list[Photo]:
        """The photos that the project lacks, in the order of the import."""
        return [photo for photo in self.photos.values() if photo.id is None]


def take_in(
    sources: Sources,
    *,
    known: Iterable[Photo],
    folder: Path = Path(),
    scratch: Path | None = None,
    unsaid: Facts = NOTHING_SAID,
    split_of: SplitOf = folders_say_nothing,
    update: bool = False,
    progress: Progress,
) -> Intake:
    """Checks every photo, and every cap against its photo.

    Args:
        sources: what was gathered.
        known: the photos of the project.
        folder: the project's.
        scratch: a folder for photos that lie within files of labels; None leaves them there.
        unsaid: what holds of photos where their file does not say otherwise.
        split_of: the split of a photo by the folders it lies in.
        update: what files say of photos counts also where the project says something else.
        progress: called once a photo.
    """
    taking = _Taking(
        search=PhotoSearch(index=PhotoIndex(known, folder=folder), named=sources.named, scratch=scratch),
        problems=list(sources.problems),
        unsaid=unsaid,
        split_of=split_of,
        update=update,
    )
    tasks: list[tuple[str, str, Callable[[], None]]] = [
        (str(path), "", lambda path=path: _take_photo(taking, path)) for path in sources.photos
    ]
    # Lists of results come last: they call images by the numbers that other files give them.
    for document in sorted(sources.documents, key=lambda document: document.found.is_results):
        taking.problems.extend(document.found.problems)
        tasks += [
            (
                str(document.path),
                image.where,
                lambda document=document, image=image: _take_labels(taking, document, image),
            )
            for image in document.found.images
        ]
    for done, (file, where, take) in enumerate(tasks):
        progress(done, len(tasks), "Checking")
        try:
            take()
        except FairyringError as error:
            taking.problems.append(Problem(file, where, _without_path(str(error), file)))
    return _taken(taking, sources)


def _without_path(sentence: str, file: str) -> str:
    """A sentence about a file that is named before it anyway."""
    if sentence.startswith(f"{file} "):
        return f"It {sentence.removeprefix(f'{file} ')}"
    return sentence.removeprefix(f"{file}: ")


class _Taking(Struct, kw_only=True):
    """An intake on its way: photos by their number in the index."""

    search: PhotoSearch
    problems: list[Problem]
    unsaid: Facts
    split_of: SplitOf
    update: bool
    told_otherwise: set[int] = field(default_factory=set)
    seen: set[int] = field(default_factory=set)
    caps: dict[int, list[FoundCap]] = field(default_factory=dict)
    splits: dict[int, list[str]] = field(default_factory=dict)
    """What files and folders say of which photo."""
    usable: Counter[str] = field(default_factory=Counter)
    """How many caps of each file."""
    meant: dict[tuple[Path, int], str] = field(default_factory=dict)
    """Which image of a file a photo is."""


def _taken(taking: _Taking, sources: Sources) -> Intake:
    photos = named_apart(taking.search.index.photos)
    in_others = _in_others(taking, photos)
    settled, in_two = in_one_split(photos, taking.splits, update=taking.update)
    follow = {
        photo.file_name
        for photo, before in zip(settled, photos, strict=True)
        if photo.id is not None and photo.split != before.split
    }
    without_labels = [
        str(document.path)
        for document in sources.documents
        if document.found.labels and not taking.usable[str(document.path)]
    ]
    return Intake(
        photos={photo.file_name: photo for photo in settled},
        seen={photos[nth].file_name for nth in taking.seen},
        caps={photos[nth].file_name: caps for nth, caps in taking.caps.items()},
        problems=[*taking.problems, *in_two],
        copies=follow,
        useless=[*sources.unreadable, *without_labels],
        told_otherwise=sorted(photos[nth].file_name for nth in taking.told_otherwise | in_others),
    )


def _in_others(taking: _Taking, photos: Sequence[Photo]) -> set[int]:
    """The photos of the project that files and folders put into other splits than it does."""
    return {
        nth
        for nth, said in taking.splits.items()
        if photos[nth].id is not None and photos[nth].split is not None and photos[nth].split not in said
    }


def _take_photo(taking: _Taking, path: Path) -> None:
    photo = structs.replace(examine(path), light=taking.unsaid.light, form=taking.unsaid.form)
    nth = taking.search.index.add(photo)
    taking.seen.add(nth)
    _note_split(taking, nth, taking.split_of(path))


def _take_labels(taking: _Taking, document: Document, image: FoundImage) -> None:
    nth = photo_of(taking.search, document.path, image)
    own = taking.meant.setdefault((document.path, nth), image.where)
    if own != image.where:
        raise StoreError(
            f"Its photo is taken for that of {own} already; put each into the folder it is called by."
        )
    if image.called is None and image.id is not None:
        taking.search.numbered.setdefault(image.id, set()).add(nth)
    photos = taking.search.index.photos
    if _says_otherwise(photos[nth], image):
        taking.told_otherwise.add(nth)
    photos[nth] = _told_more(photos[nth], image, taking.unsaid, update=taking.update)
    _note_split(taking, nth, image.split or _split_by_folders(taking, photos[nth], image))
    taking.seen.add(nth)
    caps, problems = check_caps(image.caps, photo=photos[nth], file=str(document.path))
    taking.caps.setdefault(nth, []).extend(caps)
    taking.usable[str(document.path)] += len(caps)
    taking.problems.extend(problems)
    # Kept as they were in the file, too, all caps would be in memory twice.
    image.caps.clear()


def _note_split(taking: _Taking, nth: int, split: str | None) -> None:
    if split is not None:
        taking.splits.setdefault(nth, []).append(split)


def _split_by_folders(taking: _Taking, photo: Photo, image: FoundImage) -> str | None:
    lies_in = taking.split_of(photo.source) if photo.source is not None else None
    return lies_in or split_in_name(image.file_name)


def _says_otherwise(photo: Photo, image: FoundImage) -> bool:
    """Whether a file says another light or form of a photo than the project does."""
    pairs = (photo.light, image.light), (photo.form, image.form)
    return photo.id is not None and any(ours and said and ours != said for ours, said in pairs)


def _told_more(photo: Photo, image: FoundImage, unsaid: Facts, *, update: bool) -> Photo:
    """The photo with what a file says of it; what the project knows already is changed by an update alone."""
    said = image.status or unsaid.status
    status = said if photo.status in (None, "new") else photo.status
    if photo.id is None:
        return structs.replace(
            photo,
            number=photo.number or image.id,
            light=image.light or photo.light or unsaid.light,
            form=image.form or photo.form or unsaid.form,
            status=status,
            extra=photo.extra | image.extra,
        )
    return structs.replace(
        photo,
        light=(image.light or photo.light) if update else (photo.light or image.light),
        form=(image.form or photo.form) if update else (photo.form or image.form),
        status=status or photo.status,
        extra=image.extra | photo.extra,
    )
