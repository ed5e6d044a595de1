"""The human floor from caps that people marked twice without seeing their first mark.

Two marks of one cap, each off by independent noise of the same kind, lie √2 times as far apart as one of
them lies from the truth. So the CDR between the two, over √2, is the CDR that one mark has by itself.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TypeVar

import numpy as np
from msgspec import Struct

from fairyring.model.evaluate.bootstrap import Interval, mean_interval
from fairyring.model.evaluate.centres import centre_error
from fairyring.model.geometry.shapes import Centre

Name = TypeVar("Name")
ENOUGH = 20
"""Repeats from which on they are believed rather than the marks' geometry: 20 tell a mean to a sixth."""


class CapClass(Struct, frozen=True, kw_only=True):
    """What kind of mark it is, and whose; None for what is not known."""

    annotator: str
    size: str | None
    """One of ``sizes.SIZES``."""
    shape: str | None
    """Regular (marked by a circle) or irregular."""
    visibility: str | None
    """One of ``cap_rows.visibility_class``."""


class RepeatedMark(Struct, frozen=True, kw_only=True):
    """A cap that somebody marked twice."""

    of: CapClass
    image: int
    floor: float
    """CDR, percent, that one of the two marks has by itself, as far as they say."""
    expected: float | None
    """The same from the geometry of the first mark; None where that says nothing."""


def floor_between(first: Centre, second: Centre, *, width: int, height: int) -> float:
    """CDR, percent, that one of two independent marks has by itself; centres and sizes in pixels."""
    return centre_error(second, first, width=width, height=height, diameter=None).cdr / math.sqrt(2)


def floor_of_repeats(repeats: Sequence[RepeatedMark]) -> Interval | None:
    """Mean floor, percent, with an interval of 95 %; None without repeats."""
    floors = np.array([each.floor for each in repeats], np.float64)
    return mean_interval(floors, np.array([each.image for each in repeats], np.int64))


def floors_by_class(repeats: Sequence[RepeatedMark]) -> dict[str, dict[str, Interval]]:
    """Floors per annotator, size, shape and visible share, each by the name of the class."""
    return {kind: _floors_by(repeats, kind) for kind in CapClass.__struct_fields__}


def _floors_by(repeats: Sequence[RepeatedMark], kind: str) -> dict[str, Interval]:
    groups: dict[str, list[RepeatedMark]] = {}
    for each in repeats:
        name = getattr(each.of, kind)
        if name is not None:
            groups.setdefault(name, []).append(each)
    found = ((name, floor_of_repeats(some)) for name, some in sorted(groups.items()))
    return {name: floor for name, floor in found if floor is not None}


class Hands(Struct, frozen=True, kw_only=True):
    """How many times as far off as their marks' geometry says people are."""

    by_class: dict[CapClass, float]
    by_annotator: dict[str, float]

    def floor(self, of: CapClass, expected: float | None) -> float | None:
        """The floor of a mark, percent: what its geometry says, as many times as repeats came to.

        Repeats of the same class count where there are enough, else all of the annotator's, else none.
        """
        if expected is None:
            return None
        return expected * self.by_class.get(of, self.by_annotator.get(of.annotator, 1.0))


UNKNOWN = Hands(by_class={}, by_annotator={})
"""Before anybody has marked anything again."""


def hands_of(repeats: Sequence[RepeatedMark], *, enough: int = ENOUGH) -> Hands:
    """What the repeats say of each person, overall and by class, where there are at least ``enough``."""
    known = [each for each in repeats if each.expected]
    return Hands(
        by_class=_ratios(((each.of, each) for each in known), enough),
        by_annotator=_ratios(((each.of.annotator, each) for each in known), enough),
    )


def _ratios(repeats: Iterable[tuple[Name, RepeatedMark]], enough: int) -> dict[Name, float]:
    groups: dict[Name, list[RepeatedMark]] = {}
    for name, each in repeats:
        groups.setdefault(name, []).append(each)
    return {
        name: sum(each.floor for each in some) / sum(each.expected or 0.0 for each in some)
        for name, some in groups.items()
        if len(some) >= enough
    }
