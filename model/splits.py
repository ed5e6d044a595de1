"""The splits of a data set, and the words by which programs call them."""

from __future__ import annotations

import re
from enum import StrEnum


class Split(StrEnum):
    """What the images of a data set are for."""

    train = "train"
    """To learn from."""
    val = "val"
    """To validate on, while something is learnt or chosen."""
    test = "test"
    """To measure with in the end."""


class SplitOrNone(StrEnum):
    """A split, or none of them."""

    train = "train"
    val = "val"
    test = "test"
    none = "none"


HELD_OUT_FIRST = (Split.test, Split.val, Split.train)
"""Which of several a photo belongs to: what is held out must not be learnt from."""
_WORDS = {
    **dict.fromkeys(("train", "training"), Split.train),
    **dict.fromkeys(("val", "valid", "validation"), Split.val),
    **dict.fromkeys(("test", "testing"), Split.test),
}
_YEAR = re.compile(r"[-_ ]?(19|20)[0-9]{2}$")


def split_called(word: str | None) -> Split | None:
    """The split that a word means (``valid``, ``Training``, ``val2017``); None where it is no such word."""
    return _WORDS.get(_YEAR.sub("", word.strip().casefold())) if word else None
