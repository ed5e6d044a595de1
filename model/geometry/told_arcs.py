"""What people say of pieces of a visible outline: own rim, hidden by a neighbour, cut off, or touching.

A piece is a line along the outline. What was said of it holds wherever the outline passes by that line, so it
stays with the piece when others are redrawn, and goes with it when it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, get_args

import cv2
import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from fairyring.model.geometry.boxes import box_of_outline
from fairyring.model.geometry.shapes import GeometryError, Outline, Points, points_of_part

ToldKind = Literal["visible", "hidden", "border", "contact"]
TOLD_KINDS: tuple[ToldKind, ...] = get_args(ToldKind)
MOST_ARCS = 100
MOST_POINTS = 2000
"""Most points of all that was said of one cap."""
REACH = 1.5
"""A piece is no farther from an outline than this, pixels, …"""
REACH_OF_LARGE = 0.02
"""… or than this share of the outline's larger side: it is drawn coarser than the outline."""
NOT_TOLD = -1


class ToldArc(Struct, frozen=True, kw_only=True):
    """What a person said of a piece of an outline."""

    kind: ToldKind
    """Own rim; rim of a neighbour that lies in front; where the photo or something else cuts the cap off; the
    rim of two caps that touch."""
    points: list[float]
    """Points along the outline as a flat list x0, y0, x1, y1, …; pixels."""


def require_points(arcs: Sequence[ToldArc]) -> None:
    """Raises GeometryError for points that are not finite or lack a coordinate, and for far too many."""
    if len(arcs) > MOST_ARCS or sum(len(arc.points) for arc in arcs) > 2 * MOST_POINTS:
        raise GeometryError(f"Of an outline at most {MOST_ARCS} arcs of {MOST_POINTS} points can be named.")
    for arc in arcs:
        if not arc.points or len(arc.points) % 2 or not np.isfinite(arc.points).all():
            raise GeometryError("An arc has no points, or one that is no pair of finite numbers.")


def check_told_arcs(arcs: Sequence[ToldArc], outline: Outline) -> list[ToldArc]:
    """What was said of pieces that are there; what was said of others is dropped.

    Raises GeometryError as `require_points`.
    """
    require_points(arcs)
    left, top, right, bottom = box_of_outline(outline)
    reach = max(REACH, REACH_OF_LARGE * max(right - left, bottom - top))
    rims = [points_of_part(part).astype(np.float32) for part in outline if len(part) >= 6]
    return [arc for arc in arcs if any(_is_near(rims, *point, reach) for point in _pairs(arc.points))]


def _pairs(flat: Sequence[float]) -> list[tuple[float, float]]:
    return list(zip(flat[0::2], flat[1::2], strict=True))


def _is_near(rims: Sequence[NDArray[np.float32]], x: float, y: float, reach: float) -> bool:
    return any(abs(cv2.pointPolygonTest(rim, (x, y), True)) <= reach for rim in rims)


def told_of_points(
    arcs: Sequence[ToldArc], points: Points, spacing: NDArray[np.float64]
) -> NDArray[np.int64]:
    """(K,), what was said last of each of K points (K, 2) of an outline.

    An index into TOLD_KINDS, or NOT_TOLD. ``spacing`` (K,) is the length of outline that each of them stands
    for, pixels.
    """
    told = np.full(len(points), NOT_TOLD)
    reach = np.maximum(REACH, spacing / 2)
    for arc in arcs:
        near = _distances(points, points_of_part(arc.points)) <= reach
        told[near] = TOLD_KINDS.index(arc.kind)
    return told


def _distances(points: Points, line: Points) -> NDArray[np.float64]:
    """(K,), how far points (K, 2) lie from a line through m ≥ 1 points (m, 2)."""
    starts = line[:-1] if len(line) > 1 else line
    along = np.diff(line, axis=0) if len(line) > 1 else np.zeros((1, 2))
    away = points[:, None] - starts
    length = (along**2).sum(axis=1)
    share = np.clip((away * along).sum(axis=2) / np.maximum(length, 1e-12), 0, 1)
    return np.linalg.norm(away - share[..., None] * along, axis=2).min(axis=1)
