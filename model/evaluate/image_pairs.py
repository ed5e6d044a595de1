"""Which image of the predictions is which of the truth: by file name, however tools changed it.

Base names decide, as in an import; where one occurs twice in a file, folders do.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from unicodedata import normalize

from msgspec import Struct

from fairyring.model.coco.images import ImageEntry
from fairyring.model.coco.photo_names import PhotoNames, meant
from fairyring.model.json_values import ValueRefusedError, base_name

MOST_NAMED = 3
"""How many images a sentence names."""


class Pairing(Struct, frozen=True, kw_only=True):
    """The images that were not compared, or under another name, for people to look at."""

    unpredicted: list[str] = []
    """Images of the truth that the predictions do not list; all their caps are missed."""
    unknown: list[str] = []
    """Images of the predictions that the truth does not list; they do not count."""
    renamed: dict[str, str] = {}
    """Names in the predictions that were taken for others in the truth."""

    def sentences(self) -> list[str]:
        """What somebody should hear of it."""
        told = []
        if self.unpredicted:
            told.append(
                f"The predictions lack {_listed(self.unpredicted)} of the truth; their caps count as missed."
            )
        if self.unknown:
            told.append(f"The truth lacks {_listed(self.unknown)} of the predictions; they do not count.")
        if self.renamed:
            pairs = [f"{said} for {name}" for said, name in self.renamed.items()]
            told.append(f"By their names, {_listed(pairs)} were taken.")
        return told


def partners_of(
    truths: Mapping[str, ImageEntry], predicted: Mapping[str, ImageEntry]
) -> tuple[dict[str, ImageEntry], Pairing]:
    """The predicted image of each true one, by the keys of ``named_images``; and what found no partner."""
    partners: dict[str, ImageEntry] = {}
    renamed: dict[str, str] = {}
    by_base: defaultdict[str, list[str]] = defaultdict(list)
    for key in truths:
        by_base[base_name(key)].append(key)
    known = PhotoNames(by_base)
    free = dict(predicted)
    # Names that are the same before those that only may be.
    for key, image in sorted(predicted.items(), key=lambda item: base_name(item[0]) not in by_base):
        name = meant(base_name(key), known)
        which = _nearest(key, [each for each in by_base.get(name or "", []) if each not in partners])
        if which is None:
            continue
        partners[which] = image
        del free[key]
        if base_name(key) != base_name(which):
            renamed[key] = which
    unpredicted = [key for key in truths if key not in partners]
    return partners, Pairing(unpredicted=unpredicted, unknown=list(free), renamed=renamed)


def named_images(images: Iterable[ImageEntry]) -> dict[str, ImageEntry]:
    """The images by base name, or by the whole path where two have one base name.

    Raises ValueRefusedError where a name is none, or two images have one path.
    """
    listed = [(image, base_name(image.keys.get("file_name"))) for image in images]
    count: defaultdict[str, int] = defaultdict(int)
    for _, name in listed:
        count[name] += 1
    named: dict[str, ImageEntry] = {}
    for image, name in listed:
        key = name if count[name] == 1 else _path(image)
        if key in named:
            raise ValueRefusedError(f"Another image of this file is called {key} too.")
        named[key] = image
    return named


def _path(image: ImageEntry) -> str:
    return normalize("NFC", str(image.keys["file_name"]).replace("\\", "/"))


def _nearest(key: str, others: list[str]) -> str | None:
    """The one with the most folders in common, counted from the end; None where two are as near."""
    shared = sorted(((_common_folders(key, each), each) for each in others), reverse=True)
    if not shared or (len(shared) > 1 and shared[0][0] == shared[1][0]):
        return None
    return shared[0][1]


def _common_folders(one: str, other: str) -> int:
    folders = [path.split("/")[-2::-1] for path in (one, other)]
    count = 0
    for mine, theirs in zip(*folders, strict=False):
        if mine != theirs:
            break
        count += 1
    return count


def _listed(names: list[str]) -> str:
    shown = ", ".join(names[:MOST_NAMED])
    more = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
    return f"{len(names)} image{'' if len(names) == 1 else 's'} ({shown}{more})"
