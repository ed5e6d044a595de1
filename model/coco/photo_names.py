"""Names of photos as label files write them: in another case, escaped, with a prefix that a tool added."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from difflib import get_close_matches
from unicodedata import normalize
from urllib.parse import unquote

UPLOAD = re.compile(r"[0-9a-f]{8}[-_](?=.)")
"""What Label Studio puts before the name of an uploaded photo."""
LEAST_LETTERS = 3
"""Of a stem that is looked for within another."""
MOST_COMPARED = 1000
"""Names that are compared letter by letter."""


class PhotoNames:
    """Names among which others are looked up, composed as Unicode says."""

    def __init__(self, names: Iterable[str] = ()) -> None:
        self._alike: defaultdict[str, set[str]] = defaultdict(set)
        for name in names:
            self.add(name)

    def add(self, name: str) -> None:
        """One more name."""
        self._alike[_folded(name)].add(normalize("NFC", name))

    def alike(self, name: str) -> set[str]:
        """The names that differ from this one in case at most."""
        return self._alike.get(_folded(name), set())

    def suggest(self, name: str) -> str | None:
        """A name that may be meant, for a person to decide: it holds this one, lies in it or is close."""
        stem = _stem(name)
        near = [key for key in self._alike if _is_within(_stem(key), stem) or _is_within(stem, _stem(key))]
        if not near and len(self._alike) <= MOST_COMPARED:
            near = get_close_matches(_folded(name), self._alike, n=1, cutoff=0.8)
        return min(self._alike[max(near, key=len)]) if near else None


def meant(name: str, *places: PhotoNames) -> str | None:
    """Which of the names in all places is meant by one in a file of labels.

    The same, or the only one that differs in case alone, or in what tools do to names.
    """
    for spelling in _spellings(name):
        alike = {each for names in places for each in names.alike(spelling)}
        if spelling in alike:
            return spelling
        if len(alike) == 1:
            return alike.pop()
    return None


def _spellings(name: str) -> Iterator[str]:
    """The name, then without percent-escapes, then without the prefix of an upload."""
    yield name
    # What an escape hides may be a path: only its last part is a name.
    plain = normalize("NFC", unquote(name).replace("\\", "/").rsplit("/", 1)[-1])
    yield plain
    yield UPLOAD.sub("", plain, count=1) if UPLOAD.match(plain) else plain


def _folded(name: str) -> str:
    return normalize("NFC", name).casefold()


def _stem(name: str) -> str:
    return _folded(name).rsplit(".", 1)[0]


def _is_within(part: str, whole: str) -> bool:
    """Whether a stem stands in another as a part of its own: bed_1 in x-bed_1 and not in bed_10."""
    place = re.search(rf"(?<![^\W_]){re.escape(part)}(?![^\W_])", whole)
    return len(part) >= LEAST_LETTERS and place is not None
