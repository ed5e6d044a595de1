"""The result of reconstructing a cap."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from fairyring.model.contour.silhouette import Silhouette
from fairyring.model.geometry.shapes import Fit, Points

ShapeKind = Literal["regular", "irregular"]
ArcKind = Literal["visible", "hidden", "border", "contact", "concave"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Arc:
    """A piece of a visible outline, and what it is a piece of."""

    kind: ArcKind
    """Own rim; rim of a neighbour that lies in front; the image border; the rim of two that touch, which
    people alone say; a hollow nobody accounts for."""
    points: Points
    """(k, 2), k ≥ 1, in order along the outline."""
    neighbour: Silhouette | None = None
    """The cap that lies in front, for a hidden arc, where one does."""
    told: bool = False
    """Whether a person said so."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Reconstruction:
    """A cap's whole outline, and how it came about. Positions and lengths are continuous pixels."""

    fit: Fit
    shape: ShapeKind = "regular"
    why: str = ""
    """How the outline came about, for a person: regularity, corners, C*, shape, guards."""
    arcs: tuple[Arc, ...] = ()
    """The visible outline cut up; empty for methods that do not tell arcs apart."""
    coverage_deg: float | None = None
    """How much of the whole rim is in sight, degrees of 360."""
    proposal: Literal["circle", "ellipse"] | None = None
    """What a person had better mark: a circle where too little rim is left to pin down an ellipse."""


UNSEEN = Reconstruction(fit=Fit(refusal="Nothing of this cap is visible inside the image."))
