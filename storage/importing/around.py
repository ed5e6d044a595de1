"""Looks for photos around a file of labels: beside it, and where data sets keep their images."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from unicodedata import normalize

from fairyring.model.coco.photo_names import PhotoNames, meant
from fairyring.model.photo import SUFFIXES
from fairyring.storage.errors import StoreError

IMAGES = "images"


class Around:
    """The photos around a file of labels.

    They lie beside it, in ``images/`` beside it or beside its folder (as with ``annotations/``), in folders
    there that are called as the last part of its own name (``instances_train2017.json``, ``train2017/``), in
    the folders that the file writes before their names, or where these lead. That may be another folder
    beside its own, or anywhere in what a person named; nothing else on the disk can be reached.
    """

    def __init__(self, document: Path, named: Sequence[Path]) -> None:
        """``named``: the folders that a person asked to import."""
        self._folder = document.absolute().parent
        self._named = [Path(os.path.normpath(path.absolute())) for path in named if path.is_dir()]
        self._listed: dict[Path, dict[str, Path]] = {}
        above, part = self._folder.parent, document.name.split(".")[0].rsplit("_", 1)[-1]
        within = [self._folder, self._folder / IMAGES, above / IMAGES]
        self._places = [*within, *(place / part for place in (*within, above))]
        self._places = [place for place in self._places if place.is_dir()]
        self.names = PhotoNames(name for place in self._places for name in self._list(place))

    def find(self, written: str, *, called: str) -> Path | None:
        """The photo that the file means by a path; ``called``: its base name on disk, as far as known.

        Raises:
            StoreError: it or a folder above it is a symbolic link, which could lead anywhere.
        """
        folders = [part for part in written.replace("\\", "/").split("/")[:-1] if part not in ("", ".")]
        for folder in self._folders(folders):
            listed = self._list(folder)
            path = listed.get(called) or listed.get(meant(called, PhotoNames(listed)) or "")
            if path is not None:
                return self._without_links(path)
        return None

    def _folders(self, written: list[str]) -> Iterator[Path]:
        """Where to look, the likeliest first: where the file says, then by less and less of that."""
        led_to = Path(os.path.normpath(self._folder.joinpath(*written)))
        if self._may_be_reached(led_to):
            yield led_to
        plain = [part for part in written if part != ".." and not part.endswith(":")]
        for start in range(len(plain) + 1):
            for place in self._places:
                yield place.joinpath(*plain[start:])

    def _may_be_reached(self, folder: Path) -> bool:
        beside = folder != self._folder.parent and folder.is_relative_to(self._folder.parent)
        return beside or any(folder.is_relative_to(named) for named in self._named)

    def _list(self, folder: Path) -> dict[str, Path]:
        """The photos in a folder by name."""
        if folder not in self._listed:
            files = sorted(folder.iterdir()) if folder.is_dir() else ()
            self._listed[folder] = {
                normalize("NFC", file.name): file
                for file in files
                if file.suffix.lower() in SUFFIXES and file.is_file()
            }
        return self._listed[folder]

    def _without_links(self, path: Path) -> Path:
        for link in (path, *path.parents):
            if link in self._folder.parents or link == self._folder:
                break
            if link.is_symlink():
                raise StoreError(f"{link} is a symbolic link; import what it points to first.")
        return path
