"""Upright boxes around outlines: a cheap look at what can meet before anything dear is computed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import Outline

Box = tuple[float, float, float, float]
"""Left, top, right, bottom; pixels."""

NOWHERE: Box = (math.inf, math.inf, -math.inf, -math.inf)
"""The box of an outline without points: it touches no other."""


def box_of_outline(outline: Outline) -> Box:
    """The smallest box around all parts; NOWHERE where there are no points."""
    xs = [x for part in outline for x in part[0::2]]
    ys = [y for part in outline for y in part[1::2]]
    return (min(xs), min(ys), max(xs), max(ys)) if xs and ys else NOWHERE


def boxes_of_outlines(outlines: Sequence[Outline]) -> NDArray[np.float64]:
    """(n, 4), the boxes of n outlines."""
    return np.array([box_of_outline(outline) for outline in outlines]).reshape(-1, 4)


def touching(first: NDArray[Any], second: NDArray[Any]) -> NDArray[np.bool_]:
    """(n, m), whether each of n boxes (n, 4) meets each of m (m, 4); sharing an edge counts."""
    left, top, right, bottom = first[:, :, None].transpose(1, 0, 2)
    to_left, to_top, to_right, to_bottom = second.T
    return (left <= to_right) & (right >= to_left) & (top <= to_bottom) & (bottom >= to_top)
