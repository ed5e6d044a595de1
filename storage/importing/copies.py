"""Copies of one photo: they belong to one split, whatever their names and folders."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

from msgspec import structs

from fairyring.model.splits import HELD_OUT_FIRST
from fairyring.storage.formats.found import Problem
from fairyring.storage.importing.photos import Photo


def in_one_split(
    photos: Sequence[Photo], said: Mapping[int, Sequence[str]], *, update: bool = False
) -> tuple[list[Photo], list[Problem]]:
    """The photos, those of one file in one split: where the project has it, else where it is held out.

    Args:
        photos: all that an import can speak of.
        said: the splits that files and folders say of some of them, by their place in ``photos``.
        update: what is said counts also of photos that the project has in another split.
    """
    alike: defaultdict[str, list[int]] = defaultdict(list)
    for place, photo in enumerate(photos):
        alike[photo.sha256].append(place)
    settled, problems = list(photos), []
    for place in said:
        copies = alike.pop(photos[place].sha256, [])
        known = [photos[copy].split for copy in copies if photos[copy].id is not None]
        words = {word for copy in copies for word in said.get(copy, ())}
        if not words:
            continue
        split = next(filter(None, known), None)
        if split is None or update:
            split = _strictest(words)
        for copy in copies:
            own = photos[copy].split if photos[copy].id is not None and not update else None
            settled[copy] = structs.replace(photos[copy], split=own or split)
        if len({*words, split}) > 1 and (len(words) > 1 or len(copies) > 1):
            problems.append(_told_apart([photos[copy] for copy in copies], words, split))
    return settled, problems


def _strictest(words: set[str]) -> str:
    held_out = next((split for split in HELD_OUT_FIRST if split in words), None)
    return held_out or min(words)


def _told_apart(copies: Sequence[Photo], words: set[str], split: str) -> Problem:
    names = " and ".join(sorted({photo.file_name for photo in copies}))
    one = "Copies of one photo" if len(copies) > 1 else "One photo"
    reason = f"{one}, said to be of the splits {' and '.join(sorted({*words, split}))}: it is {split} now."
    return Problem(names, "", reason)
