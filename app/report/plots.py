"""Where predicted centres lie from the marked ones, as SVG."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from fairyring.app.panels.markup import Markup, element
from fairyring.app.panels.plotted import further_out
from fairyring.app.report.drawing import Drawing, figure_of
from fairyring.model.evaluate.spread import axes_of_spread, reach_of

SIDE = 320
PREDICTED = "Predicted minus marked centre"


def shifts(found: Sequence[tuple[float, float]], *, what: str = PREDICTED) -> Markup:
    """A dot for each cap where its predicted centre lies from the marked one; the ellipse holds 95 of 100.

    ``what`` the dots are, as the caption says it.
    """
    drawn = drawing_of_shifts(found, what=what)
    if not drawn:
        told = "Fewer than three caps were measured, too few to show how centres shift."
        return element("p", told, class_="quiet")
    return figure_of(drawn)


def drawing_of_shifts(found: Sequence[tuple[float, float]], *, what: str = PREDICTED) -> list[Drawing]:
    """The same as a drawing; none where fewer than three caps were measured."""
    if len(found) < 3:
        return []
    moves = np.array(found)
    reach = reach_of(moves)
    scale = SIDE / 2 / reach
    inside = moves[(np.abs(moves) <= reach).all(axis=1)]
    dots = [element("circle", cx=_at(x, scale), cy=_at(y, scale), r=2, class_="dot") for x, y in inside]
    mean = moves.mean(axis=0)
    axes = (
        element("line", x1=0, x2=SIDE, y1=SIDE / 2, y2=SIDE / 2, class_="axis"),
        element("line", y1=0, y2=SIDE, x1=SIDE / 2, x2=SIDE / 2, class_="axis"),
    )
    cross = element("circle", cx=_at(mean[0], scale), cy=_at(mean[1], scale), r=4, class_="mean")
    caption = f"{what}, pixels, edges at ±{reach:.1f}; on the whole Δx {mean[0]:+.2f} and Δy {mean[1]:+.2f}."
    if beyond := len(moves) - len(inside):
        caption += f" {further_out(beyond)}"
    parts = [*axes, *dots, _ellipse(moves, scale), cross]
    return [Drawing(caption=caption, width=SIDE, height=SIDE, parts=parts)]


def _at(value: float, scale: float) -> float:
    return round(SIDE / 2 + value * scale, 1)


def _ellipse(moves: np.ndarray[Any, np.dtype[np.float64]], scale: float) -> Markup:
    """Where 95 of 100 lie if they scatter normally."""
    radii, vectors = axes_of_spread(moves)
    radii = radii * scale
    angle = float(np.degrees(np.arctan2(vectors[1, 1], vectors[0, 1])))
    x, y = (_at(float(mean), scale) for mean in moves.mean(axis=0))
    return element(
        "ellipse",
        cx=x,
        cy=y,
        rx=round(float(radii[1]), 1),
        ry=round(float(radii[0]), 1),
        transform=f"rotate({angle:.1f} {x} {y})",
        class_="spread",
    )
