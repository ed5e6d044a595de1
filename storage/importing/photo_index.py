"""The photos that an import can speak of: those of the project, and new ones that it brings along."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from pathlib import Path, PurePosixPath

from fairyring.model.coco.ids import Id
from fairyring.model.coco.photo_names import PhotoNames
from fairyring.storage.errors import StoreError
from fairyring.storage.formats.found import FoundImage
from fairyring.storage.importing.photos import Photo, folders_of, show_the_same
from fairyring.storage.originals import digest_of_file

MOST_NAMED = 4
"""Images that a message lists."""


class PhotoIndex:
    """Photos, each with a number, found by base name, by content and by the folders above them."""

    def __init__(self, known: Iterable[Photo], *, folder: Path) -> None:
        """``known``: the photos of the project, which lies in ``folder``."""
        self.photos: list[Photo] = []
        self.names = PhotoNames()
        self._folder = folder
        self._called: defaultdict[str, list[int]] = defaultdict(list)
        for photo in known:
            self._append(photo)

    def add(self, photo: Photo) -> int:
        """The number of a photo that was found on disk: its own, or that of the same photo.

        Of one base name, files with the same bytes are one photo, and so are those that show the same, as
        programs save photos anew; all others are another photo, from another folder.

        Raises StoreError where another one of that name, in other letters, lies in the same folder.
        """
        alike = self.called(photo.file_name)
        for nth in alike:
            if self.photos[nth].sha256 == photo.sha256:
                return nth
        for nth in alike:
            if photo.source is not None and self._show_the_same(self.photos[nth], photo, photo.source):
                return nth
        for nth in alike:
            beside = self.photos[nth].source
            if beside is not None and photo.source is not None and beside.parent == photo.source.parent:
                raise StoreError(
                    f"{photo.source}: Beside it lies another photo of the same name, written in other "
                    "letters; rename one of them."
                )
        return self._append(photo)

    def called(self, base_name: str) -> list[int]:
        """The numbers of the photos with this base name."""
        return self._called.get(base_name, [])

    def with_content(self, base_name: str, sha256: str) -> int | None:
        """The number of the photo with this base name and these bytes."""
        return next((nth for nth in self.called(base_name) if self.photos[nth].sha256 == sha256), None)

    def numbered(self, called: Id) -> int | None:
        """The number of the photo that a list of results calls by a number of the project, or by its name.

        Raises StoreError where that could be two photos.
        """
        by_id = [nth for nth, photo in enumerate(self.photos) if photo.id is not None and photo.id == called]
        stems = {str(called), PurePosixPath(str(called)).stem}
        by_name = [nth for base, alike in self._called.items() for nth in alike if _is_called(base, stems)]
        found = {*by_id, *by_name}
        if len(found) > 1:
            names = " or ".join(self._name_of(nth) for nth in sorted(found)[:MOST_NAMED])
            raise StoreError(
                f"This may be {names}; import the results along with the COCO file that lists their images."
            )
        return found.pop() if found else None

    def meant_by(self, image: FoundImage, base_name: str) -> int | None:
        """The number of the photo that a file means, where none lies beside it; None where there is none.

        Raises:
            StoreError: there are several, or none has the size that the file says.
        """
        alike = self.called(base_name)
        fitting = [nth for nth in alike if has_size(self.photos[nth], image)]
        if alike and not fitting:
            raise other_size(self.photos[alike[0]], image)
        if len(fitting) < 2:
            return fitting[0] if fitting else None
        written = PurePosixPath(image.file_name.replace("\\", "/")).parts
        shared = [self._folders_shared(nth, written[:-1]) for nth in fitting]
        best = [nth for nth, count in zip(fitting, shared, strict=True) if count == max(shared)]
        if len(best) == 1:
            return best[0]
        names = ", ".join(self._name_of(nth) for nth in best[:MOST_NAMED])
        raise StoreError(
            f"Several images are called {base_name}: {names}; write the folder before its name in this file."
        )

    def _append(self, photo: Photo) -> int:
        base = PurePosixPath(photo.file_name).name
        self.photos.append(photo)
        self.names.add(base)
        self._called[base].append(len(self.photos) - 1)
        return len(self.photos) - 1

    def _show_the_same(self, known: Photo, photo: Photo, source: Path) -> bool:
        if (known.width, known.height) != (photo.width, photo.height):
            return False
        if known.path is None:
            return known.source is not None and show_the_same(known.source, source)
        file = self._folder / known.path
        # Where the file was replaced since, it tells nothing of the photo that was imported.
        return file.exists() and digest_of_file(file) == known.sha256 and show_the_same(file, source)

    def _folders_shared(self, nth: int, written: Sequence[str]) -> int:
        """How many folders before a name are the same; more than all where the file says all there are."""
        own = folders_of(self.photos[nth])
        if list(own) == list(written):
            return len(own) + 1
        pairs = zip(reversed(own), reversed(written), strict=False)
        return next(
            (count for count, pair in enumerate(pairs) if pair[0] != pair[1]), min(len(own), len(written))
        )

    def _name_of(self, nth: int) -> str:
        photo = self.photos[nth]
        return photo.file_name if photo.source is None else str(photo.source)


def _is_called(base: str, stems: set[str]) -> bool:
    """Whether a photo has the name that a list of results gives, with or without leading zeros."""
    stem = PurePosixPath(base).stem
    return stem in stems or (stem.isdecimal() and stem.lstrip("0") in stems)


def has_size(photo: Photo, image: FoundImage) -> bool:
    """Whether a photo has the size that a file says, as far as it says one."""
    return image.width in (None, photo.width) and image.height in (None, photo.height)


def other_size(photo: Photo, image: FoundImage) -> StoreError:
    """The error of a photo that has another size than a file says."""
    return StoreError(
        f"{PurePosixPath(photo.file_name).name} is {photo.width} × {photo.height} pixels when upright, "
        f"but this file says {image.width} × {image.height}."
    )
