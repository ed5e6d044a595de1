"""Which image of the predictions is which of the truth: by file name, however tools changed it.

Base names decide, as in an import; where one occurs twice in a file, folders do.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from typing import Literal
from unicodedata import normalize

from msgspec import UNSET, Struct, UnsetType

from fairyring.model.coco.images import ImageEntry
from fairyring.model.coco.photo_names import PhotoNames, meant
from fairyring.model.json_values import ValueRefusedError, base_name

MOST_NAMED = 3
"""How many images a sentence names."""


class Pairing(Struct, frozen=True, kw_only=True):
    """Images that were not compared, or under another name, and what looks strange, for people to see."""

    unpredicted: list[str] = []
    """Images of the truth that the predictions do not list; all their caps are missed."""
    unknown: list[str] = []
    """Images of the predictions that the truth does not list; they do not count."""
    renamed: dict[str, str] = {}
    """Names in the predictions that were taken for others in the truth."""
    swapped: Literal[True] | UnsetType = UNSET
    """Said where all of the truth carries scores, as predictions do, and nothing of the predictions."""

    def sentences(self) -> list[str]:
        """What somebody should hear of it."""
        told = []
        if self.swapped is True:
            told.append(
                "Every cap of the truth carries a score and none of the predictions: "
                "have they been swapped? The truth comes last."
            )
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
    true_paths = {key: _path(image) for key, image in truths.items()}
    by_base: defaultdict[str, list[str]] = defaultdict(list)
    for key in truths:
        by_base[base_name(key)].append(key)
    known = PhotoNames(by_base)
    exact: defaultdict[str, dict[str, str]] = defaultdict(dict)
    likely: defaultdict[str, dict[str, str]] = defaultdict(dict)
    for key, image in predicted.items():
        name = meant(base_name(key), known)
        if name is not None:
            (exact if base_name(key) in by_base else likely)[name][key] = _path(image)
    partners: dict[str, str] = {}
    # Names that are the same before those that only may be.
    for said in (exact, likely):
        for name, paths in said.items():
            free = {each: true_paths[each] for each in by_base[name] if each not in partners}
            partners |= _nearest_pairs(free, paths)
    taken = set(partners.values())
    renamed = {key: which for which, key in partners.items() if base_name(key) != base_name(which)}
    pairing = Pairing(
        unpredicted=[key for key in truths if key not in partners],
        unknown=[key for key in predicted if key not in taken],
        renamed=renamed,
    )
    return {which: predicted[key] for which, key in partners.items()}, pairing


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


def _nearest_pairs(true_paths: Mapping[str, str], said_paths: Mapping[str, str]) -> dict[str, str]:
    """Keys of paths of one base name that belong together, as each is nearest to the other."""
    pairs: dict[str, str] = {}
    free, left = dict(true_paths), dict(said_paths)
    for key, path in said_paths.items():
        which = _nearest(path, free)
        if which is not None and _nearest(true_paths[which], left) == key:
            pairs[which] = key
            del free[which], left[key]
    return pairs


def _nearest(path: str, others: Mapping[str, str]) -> str | None:
    """The key of the path with the most folders in common, counted from the end; None where two have."""
    shared = sorted(((_common_folders(path, other), key) for key, other in others.items()), reverse=True)
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
