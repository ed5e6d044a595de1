"""The paper's reconstruction (section 5), one cap at a time; `Reading` holds its open choices."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import pi, sqrt
from typing import Literal

import numpy as np

from fairyring.model.contour.arch import arch_curvature, arch_height, arch_radius, arch_ratio, chord_length
from fairyring.model.contour.circle import enclosing_circle, minimum_distance_circle
from fairyring.model.contour.classify import Limits, corners_of, defects_of, longest, sub_contours
from fairyring.model.contour.ellipse import axis_ratio, least_squares_ellipse, mean_radius
from fairyring.model.geometry.shapes import Circle, Ellipse, Points


@dataclass(frozen=True, slots=True, kw_only=True)
class Reading:
    """How section 5 is read where it contradicts itself; docs/contours.md gives the reasons."""

    limits: Limits = field(default_factory=Limits)
    arch: Literal["ratio", "printed"] = "ratio"
    """C* = height / chord, or C = 1 / R in 1/px with Equation 5 as printed."""
    arch_limit: float = 0.6
    least_points: int = 30
    """A sub-contour of fewer pixels gets a circle."""
    guarded: bool = True
    radius_range: tuple[float, float] = (0.85, 1.6)
    """A guarded radius lies between so many times that of the equal area and that of the enclosing circle."""
    least_axis_ratio: float = 0.55


PAPER = Reading()
LITERAL = Reading(limits=Limits(kind="printed"), arch="printed", guarded=False)


@dataclass(frozen=True, slots=True)
class Steps:
    """What the paper's method saw and did with one contour, step by step."""

    whole: Circle | Ellipse
    shape: Literal["regular", "irregular"]
    why: str
    corners: list[int]
    """Indices into the contour."""
    pieces: list[Points]
    chosen: Points
    """The sub-contour that was fitted."""


def reconstruct_contour(contour: Points, *, area: float, reading: Reading = PAPER) -> Steps:
    """The whole outline behind a visible contour of n ≥ 1 pixels around an area (px²)."""
    kept = [d for d in defects_of(contour) if not reading.limits.ignore(d, length=len(contour), area=area)]
    corners = corners_of(kept)
    pieces = sub_contours(contour, corners)
    piece = longest(pieces)
    shape, story = ("irregular", [f"irregular: {len(corners)} corners"]) if kept else ("regular", ["regular"])
    ratio = arch_ratio(piece) if kept else float("inf")
    if kept:
        story.append(f"longest piece {len(piece)} of {len(contour)} px, C* {ratio:.2f}")
    by_ellipse = not kept or (
        len(piece) >= reading.least_points and _arch(piece, reading) > reading.arch_limit
    )
    refused = []
    for name, whole in _attempts(contour, piece, by_ellipse=by_ellipse):
        if whole is None:
            refused.append(f"{name} failed")
            continue
        fault = _fault(whole, contour, area=area, reading=reading) if reading.guarded else None
        if fault is None:
            return Steps(whole, shape, "; ".join([*story, *refused, name]), corners, pieces, piece)
        refused.append(f"{name} refused ({fault})")
    name, whole = "enclosing circle", enclosing_circle(contour)
    return Steps(whole, shape, "; ".join([*story, *refused, name]), corners, pieces, piece)


def _arch(piece: Points, reading: Reading) -> float:
    if reading.arch == "ratio":
        return arch_ratio(piece)
    chord, height = chord_length(piece), arch_height(piece)
    return arch_curvature(arch_radius(chord=chord, height=height, whole_chord=True)) if height > 0 else 0.0


def _attempts(
    contour: Points, piece: Points, *, by_ellipse: bool
) -> Iterator[tuple[str, Circle | Ellipse | None]]:
    """What to try, in order of preference, each fitted only when its turn comes."""
    if by_ellipse:
        yield "ellipse", least_squares_ellipse(piece)
    yield "minimum-distance circle", minimum_distance_circle(piece)
    if piece is not contour:
        yield "ellipse on the whole contour", least_squares_ellipse(contour)


def _fault(whole: Circle | Ellipse, contour: Points, *, area: float, reading: Reading) -> str | None:
    """Why a fit cannot be the cap's outline, in a few words, or None."""
    around = enclosing_circle(contour)
    low, high = reading.radius_range
    if np.hypot(whole.cx - around.cx, whole.cy - around.cy) > around.r:
        return "centre outside the enclosing circle"
    if mean_radius(whole) < low * sqrt(area / pi):
        return "too small for the visible area"
    if mean_radius(whole) > high * around.r:
        return "too large for the enclosing circle"
    if axis_ratio(whole) < reading.least_axis_ratio:
        return "too flat"
    return None
