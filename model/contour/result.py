"""What a reconstruction says of a cap."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from fairyring.model.geometry.shapes import Circle, Ellipse, Points

ShapeKind = Literal["regular", "irregular"]
ArcKind = Literal["visible", "hidden", "border", "concave"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Arc:
    """A piece of a visible outline, and what it is a piece of."""

    kind: ArcKind
    """Own rim; rim of a neighbour that lies in front; the image border; a hollow nobody accounts for."""
    points: Points
    """(k, 2), k ≥ 1, in order along the outline."""
    neighbour: int | None = None
    """Index of the cap that lies in front, for a hidden arc."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Reconstruction:
    """What is known of one cap's whole outline. Positions and lengths are continuous pixels."""

    whole: Circle | Ellipse | None = None
    centre: tuple[float, float] | None = None
    centre_sd: tuple[float, float] | None = None
    """One standard deviation along x and y; None for methods that do not know it."""
    shape: ShapeKind = "regular"
    refusal: str | None = None
    """Why there is no outline, as a sentence; then whole and centre are None."""
    why: str = ""
    """How the outline came about, for a person: regularity, corners, C*, shape, guards."""
    arcs: tuple[Arc, ...] = ()
    """The visible outline cut up; empty for methods that do not tell arcs apart."""
    coverage_deg: float | None = None
    """How much of the whole rim is in sight, degrees of 360."""
    residual: float | None = None
    """Root mean square distance of the visible rim from the outline."""
    proposal: Literal["circle", "ellipse"] | None = None
    """What a person had better mark: a circle where too little rim is left to pin down an ellipse."""
    order: int | None = None
    """Rank in the image's overlap order, 0 the rearmost."""
    order_confidence: float | None = None
    """The least certain of the decisions on who lies in front that this cap took part in, 0.5 to 1."""
