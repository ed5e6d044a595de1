"""The methods by name: each takes an image's caps and says what it makes of those that are wanted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import dist

import numpy as np
from numpy.typing import NDArray

from fairyring.model.contour.arcs import arcs_of, kinds_of
from fairyring.model.contour.circle import enclosing_circle
from fairyring.model.contour.ellipse import grown, hull_ellipse, least_squares_ellipse, mean_radius
from fairyring.model.contour.harmonic import Array, Outlines
from fairyring.model.contour.order import overlap_order
from fairyring.model.contour.paper import LITERAL, PAPER, Reading, reconstruct_contour
from fairyring.model.contour.priors import DEFAULT, Priors
from fairyring.model.contour.result import Reconstruction, ShapeKind
from fairyring.model.contour.silhouette import RIM_INSET, Silhouette, contours_of
from fairyring.model.contour.together import Together, fit_together
from fairyring.model.geometry.shapes import Circle, Ellipse, Points, canonical_ellipse

ELLIPSE_FROM_DEG = 200.0
"""With less of the rim in sight than this, a circle is the better mark (section 5.2's C* of 0.6)."""
LEAST_PIXELS = 8
"""A contour shorter than this is a dot: the circle around it is all there is to say."""
LEAST_FILL = 0.12
"""A visible area below this share of the enclosing circle's squared radius is a thread that shows no rim."""
GUARDED_SD = 0.25
"""Where a guard fired, the centre is known no better than to this share of the radius."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """An image's caps, each with something to see."""

    caps: Sequence[Silhouette]
    width: int
    height: int
    priors: Priors = DEFAULT


Method = Callable[[Scene, Sequence[int]], list[Reconstruction]]


def by_map(scene: Scene, wanted: Sequence[int]) -> list[Reconstruction]:
    """The robust, prior-aware, occlusion-aware ellipse."""
    together = fit_together(scene.caps, scene.priors, width=scene.width, height=scene.height)
    rank, confidence = overlap_order(together.meetings, caps=len(scene.caps))
    kinds = kinds_of(together)
    known = _Known(
        kinds=kinds,
        degrees=360 * together.coverage,
        sd=together.centre_sd,
        residual=_root_mean_square(together.fit.residual, where=kinds == 0),
        rank=rank,
        confidence=confidence,
    )
    return [_from_fit(together, known, cap) for cap in wanted]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Known:
    """What there is to say of n caps besides their outlines, as in `Reconstruction`."""

    kinds: NDArray[np.int_]
    """As `kinds_of` gives them."""
    degrees: Array
    sd: Array
    residual: Array
    rank: NDArray[np.int_]
    confidence: Array


def _from_fit(together: Together, known: _Known, cap: int) -> Reconstruction:
    whole, guard = _guarded(together, cap)
    arcs = arcs_of(together, cap, known.kinds)
    degrees, sd = float(known.degrees[cap]), known.sd[cap]
    if guard is not None:
        sd = np.maximum(sd, GUARDED_SD * mean_radius(whole))
    lost = sum(arc.kind != "visible" for arc in arcs)
    shape = "irregular" if lost else "regular"
    arcs_lost = f", {lost} arc{'s' if lost > 1 else ''} of the outline not" if lost else ""
    return Reconstruction(
        whole=whole,
        centre=(whole.cx, whole.cy),
        centre_sd=(float(sd[0]), float(sd[1])),
        shape=shape,
        why=f"{shape}: {degrees:.0f}° of the rim in sight{arcs_lost}; {guard or 'most probable ellipse'}",
        arcs=arcs,
        coverage_deg=degrees,
        residual=float(known.residual[cap]),
        proposal="ellipse" if degrees >= ELLIPSE_FROM_DEG else "circle",
        order=int(known.rank[cap]),
        order_confidence=float(known.confidence[cap]),
    )


def _guarded(together: Together, cap: int) -> tuple[Circle | Ellipse, str | None]:
    """The outline of a cap; or the circle around what is visible, and why."""
    (x, y), r = together.around.centre[cap].tolist(), float(np.exp(together.around.log_radius[cap]))
    around = Circle(cx=x, cy=y, r=r)
    if together.rims.pixels[cap] < LEAST_PIXELS:
        return around, "too small to fit; enclosing circle"
    if together.rims.area[cap] < LEAST_FILL * r**2:
        return around, "too thin to fit; enclosing circle"
    ellipse = _ellipse(together.fit.outlines, cap)
    if not np.isfinite([ellipse.cx, ellipse.cy, ellipse.a, ellipse.b]).all():
        return around, "no fit; enclosing circle"
    if np.hypot(ellipse.cx - x, ellipse.cy - y) > r:
        return around, "centre outside the enclosing circle; enclosing circle"
    return ellipse, None


def _root_mean_square(values: Array, *, where: NDArray[np.bool_]) -> Array:
    """Of each row (n, K), 0 where there is nothing to average."""
    return np.sqrt((values**2 * where).sum(axis=1) / np.maximum(where.sum(axis=1), 1))


def _ellipse(outlines: Outlines, cap: int) -> Ellipse:
    (cx, cy), r = outlines.centre[cap].tolist(), float(np.exp(outlines.log_radius[cap]))
    u, v = outlines.shape[cap, :2].tolist()
    size = float(np.hypot(u, v))
    angle = float(np.degrees(np.arctan2(v, u) / 2))
    return canonical_ellipse(cx, cy, r * float(np.exp(size)), r * float(np.exp(-size)), angle)


def by_reading(reading: Reading) -> Method:
    """The paper's method, read so."""

    def fit(contour: Points, area: float) -> Reconstruction:
        steps = reconstruct_contour(contour, area=area, reading=reading)
        return _found(grown(steps.whole, RIM_INSET), shape=steps.shape, why=steps.why)

    return _one_by_one(fit)


def _by_ellipse(contour: Points, _area: float) -> Reconstruction:
    whole = least_squares_ellipse(contour)
    if whole is None:
        return _found(enclosing_circle(contour), why="too few points for an ellipse; enclosing circle")
    return _found(grown(whole, RIM_INSET), why="ellipse on the whole contour")


def _by_hull(contour: Points, _area: float) -> Reconstruction:
    whole, around = hull_ellipse(contour), enclosing_circle(contour)
    if whole is None:
        return _found(around, why="too few corners for an ellipse; enclosing circle")
    if dist((whole.cx, whole.cy), (around.cx, around.cy)) > around.r:
        return _found(around, why="centre outside the enclosing circle; enclosing circle")
    return _found(grown(whole, RIM_INSET), why="ellipse on the convex hull of the contour")


def _by_enclosing_circle(contour: Points, _area: float) -> Reconstruction:
    # Not grown: the circle rests on the outermost pixels, whose centres all but reach the edge.
    return _found(enclosing_circle(contour), why="enclosing circle")


def _one_by_one(fit: Callable[[Points, float], Reconstruction]) -> Method:
    """A method that looks at the longest contour of one cap at a time."""

    def method(scene: Scene, wanted: Sequence[int]) -> list[Reconstruction]:
        caps = [scene.caps[cap] for cap in wanted]
        return [fit(contours_of(cap, least=1)[0], float(cap.mask.sum())) for cap in caps]

    return method


def _found(whole: Circle | Ellipse, *, shape: ShapeKind = "regular", why: str) -> Reconstruction:
    return Reconstruction(whole=whole, centre=(whole.cx, whole.cy), shape=shape, why=why)


METHODS: dict[str, Method] = {
    "map": by_map,
    "paper": by_reading(PAPER),
    "literal": by_reading(LITERAL),
    "ellipse": _one_by_one(_by_ellipse),
    "hull": _one_by_one(_by_hull),
    "enclosing": _one_by_one(_by_enclosing_circle),
}
DEFAULT_METHOD = "map"
