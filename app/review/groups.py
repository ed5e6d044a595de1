"""In which order the groups of a review stand, so that a row is found where one looks for it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeVar

from fairyring.model.evaluate.sizes import SIZES
from fairyring.model.light_and_form import FORMS, LIGHTS

Figures = TypeVar("Figures")

TITLES = {
    "size": "By size",
    "visibility": "By how much is in sight",
    "shape": "By kind of mark",
    "light": "By light",
    "form": "By form",
    "annotator": "By annotator",
}
NATURAL: dict[str, tuple[str, ...]] = {
    "size": SIZES,
    "visibility": ("95_percent_and_more", "60_to_95_percent", "under_60_percent"),
    "shape": ("regular", "irregular"),
    "light": LIGHTS,
    "form": FORMS,
}
"""The order that values have by themselves; people, who have none, stand worst first."""
WORDS = {
    "95_percent_and_more": "95 % and more",
    "60_to_95_percent": "60 to 95 %",
    "under_60_percent": "under 60 %",
}
NOT_KNOWN = "not_known"
"""The group of those of which it is not known; it stands last, so that groups add up to the whole."""


def words_of(value: str) -> str:
    """A value of a group as people read it."""
    return WORDS.get(value, value.replace("_", " "))


def in_order(
    kind: str, groups: Mapping[str, Figures], *, cdr: Callable[[Figures], float | None]
) -> dict[str, Figures]:
    """The groups of a kind in the order of their kind, else the highest CDR first; those without one last.

    Args:
        kind: what the caps are grouped by.
        groups: figures by value.
        cdr: the mean CDR of some figures, None where nothing was measured.
    """
    natural = NATURAL.get(kind, ())

    def place(value: str) -> tuple[int, float, str]:
        if value == NOT_KNOWN:
            return len(natural) + 1, 0.0, value
        mean = cdr(groups[value])
        rank = natural.index(value) if value in natural else len(natural)
        worst_first = 0.0 if rank < len(natural) else float("inf") if mean is None else -mean
        return rank, worst_first, value

    return {value: groups[value] for value in sorted(groups, key=place)}
