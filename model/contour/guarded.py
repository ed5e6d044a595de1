"""What is handed out of a fit: the outline, unless it cannot be trusted, and how it came about."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fairyring.model.contour.arcs import arcs_of, kinds_of
from fairyring.model.contour.ellipse import mean_radius
from fairyring.model.contour.harmonic import Array, Outlines
from fairyring.model.contour.result import Reconstruction
from fairyring.model.contour.together import Together
from fairyring.model.geometry.shapes import Circle, Ellipse, canonical_ellipse, fit_of_shape

ELLIPSE_FROM_DEG = 200.0
"""With less of the rim in sight than this, a circle is the better mark (section 5.2's C* of 0.6)."""
LEAST_PIXELS = 8
"""A contour shorter than this is a dot: the circle around it is all there is to say."""
LEAST_FILL = 0.12
"""A visible area below this share of the enclosing circle's squared radius is a thread that shows no rim."""
GUARDED_SD = 0.25
"""Where a guard fired, the centre is known no better than to this share of the radius."""


def reconstructions_of(together: Together) -> list[Reconstruction]:
    """What the last look says of each cap."""
    kinds = kinds_of(together)
    known = _Known(
        kinds=kinds,
        degrees=360 * together.coverage,
        sd=together.centre_sd,
    )
    return [_reconstruction(together, known, cap) for cap in range(len(kinds))]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Known:
    """What there is to say of n caps besides their outlines, as in `Reconstruction`."""

    kinds: NDArray[np.int_]
    """As `kinds_of` gives them."""
    degrees: Array
    sd: Array


def _reconstruction(together: Together, known: _Known, cap: int) -> Reconstruction:
    whole, guard = _guarded(together, cap)
    arcs = arcs_of(together, cap, known.kinds)
    degrees, sd = float(known.degrees[cap]), known.sd[cap]
    if guard is not None:
        sd = np.maximum(sd, GUARDED_SD * mean_radius(whole))
    lost = sum(arc.kind not in ("visible", "contact") for arc in arcs)
    shape = "irregular" if lost else "regular"
    arcs_lost = f", {lost} arc{'s' if lost > 1 else ''} of the outline not" if lost else ""
    return Reconstruction(
        fit=fit_of_shape(whole, centre_sd=(float(sd[0]), float(sd[1]))),
        shape=shape,
        why=f"{shape}: {degrees:.0f}° of the rim in sight{arcs_lost}; {guard or 'most probable ellipse'}",
        arcs=arcs,
        coverage_deg=degrees,
        proposal="ellipse" if degrees >= ELLIPSE_FROM_DEG else "circle",
    )


def _guarded(together: Together, cap: int) -> tuple[Circle | Ellipse, str | None]:
    """The outline of a cap; or the circle around what is visible, and why."""
    (x, y), r = together.around.centre[cap].tolist(), float(np.exp(together.around.log_radius[cap]))
    around = Circle(cx=x, cy=y, r=r)
    if together.rims.pixels[cap] < LEAST_PIXELS:
        return around, "too small to fit; enclosing circle"
    if together.rims.area[cap] < LEAST_FILL * r**2:
        return around, "too thin to fit; enclosing circle"
    ellipse = _ellipse(together.look.estimate.outlines, cap)
    if not np.isfinite([ellipse.cx, ellipse.cy, ellipse.a, ellipse.b]).all():
        return around, "no fit; enclosing circle"
    if np.hypot(ellipse.cx - x, ellipse.cy - y) > r:
        return around, "centre outside the enclosing circle; enclosing circle"
    return ellipse, None


def _ellipse(outlines: Outlines, cap: int) -> Ellipse:
    (cx, cy), r = outlines.centre[cap].tolist(), float(np.exp(outlines.log_radius[cap]))
    u, v = outlines.shape[cap, :2].tolist()
    size = float(np.hypot(u, v))
    angle = float(np.degrees(np.arctan2(v, u) / 2))
    return canonical_ellipse(cx, cy, r * float(np.exp(size)), r * float(np.exp(-size)), angle)
