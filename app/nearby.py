"""Which caps lie near which: a cheap look at boxes before anything dear is computed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

from storage.records import Outline

Key = TypeVar("Key")
Box = tuple[float, float, float, float]
"""Left, top, right, bottom; pixels."""


def box_of(outline: Outline) -> Box | None:
    """The box around an outline; None of an empty one."""
    xs = [x for part in outline for x in part[0::2]]
    ys = [y for part in outline for y in part[1::2]]
    return (min(xs), min(ys), max(xs), max(ys)) if xs and ys else None


def keys_near(outline: Outline, others: Mapping[Key, Outline], *, reach: float = 0.0) -> list[Key]:
    """Whose box touches that of ``outline`` widened on all sides by ``reach`` times its longer side."""
    box = box_of(outline)
    if box is None:
        return []
    left, top, right, bottom = box
    margin = reach * max(right - left, bottom - top)
    return [
        key
        for key, other in others.items()
        if (near := box_of(other)) is not None
        and near[0] <= right + margin
        and near[2] >= left - margin
        and near[1] <= bottom + margin
        and near[3] >= top - margin
    ]
