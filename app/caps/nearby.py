"""Which caps lie near which: a cheap look at boxes before anything dear is computed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TypeVar

from fairyring.storage.records import Outline

Key = TypeVar("Key")
Box = tuple[float, float, float, float]
"""Left, top, right, bottom; pixels."""

MOST_KEPT = 20_000
NOWHERE: Box = (math.inf, math.inf, -math.inf, -math.inf)
"""Touches no box."""


def box_of(outline: Outline) -> Box | None:
    """The box around an outline; None of an empty one."""
    xs = [x for part in outline for x in part[0::2]]
    ys = [y for part in outline for y in part[1::2]]
    return (min(xs), min(ys), max(xs), max(ys)) if xs and ys else None


class Boxes:
    """Remembers the boxes of outlines, which are never changed in place; the same list, the same box."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[Outline, Box | None]] = {}

    def of(self, outline: Outline) -> Box | None:
        """``box_of``, computed once an outline."""
        known = self._known.get(id(outline))
        if known is not None and known[0] is outline:
            return known[1]
        if len(self._known) >= MOST_KEPT:
            self._known.clear()
        box = box_of(outline)
        self._known[id(outline)] = (outline, box)
        return box


def around(outline: Outline, *, reach: float) -> Box:
    """The box of ``outline`` widened on all sides by ``reach`` times its longer side; NOWHERE if empty."""
    left, top, right, bottom = box_of(outline) or NOWHERE
    margin = reach * max(right - left, bottom - top, 0)
    return left - margin, top - margin, right + margin, bottom + margin


def keys_near(
    outline: Outline, others: Mapping[Key, Outline], *, boxes: Boxes, reach: float = 0.0
) -> list[Key]:
    """Whose box touches that of ``outline`` widened on all sides by ``reach`` times its longer side."""
    left, top, right, bottom = around(outline, reach=reach)
    return [
        key
        for key, other in others.items()
        if (near := boxes.of(other)) is not None
        and near[0] <= right
        and near[2] >= left
        and near[1] <= bottom
        and near[3] >= top
    ]
