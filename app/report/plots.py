"""Plots of a review as SVG: CDR by image (as the paper's Figure 19), and where predicted centres lie."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fairyring.app.panels.markup import Markup, element
from fairyring.app.report.bar_names import bar_names, room_for
from fairyring.model.evaluate.spread import axes_of_spread, reach_of

WIDTH, TALLEST = 720, 224
LEFT, TOP = 48, 8
"""Room for the numbers at the axis, and above the plot."""
SIDE = 320
WIDEST = 80
"""Of a bar."""
MOST_BARS = 64
"""More bars than that leave no room for their names."""
TICKS = 5
"""So many numbers at an axis at most, besides its zero."""


@dataclass(frozen=True, kw_only=True)
class Bar:
    """The CDR of an image or of a cap, and of its marks alone; percent."""

    name: str
    cdr: float
    floor: float | None


def cdr_bars(measured: Sequence[Bar], *, what: str, nothing: str = "Nothing was measured.") -> Markup:
    """A bar for each CDR in the order given, the floor of its marks a line across; ``what`` they are of.

    ``nothing``: what is said where there is no bar.
    """
    shown = measured[:MOST_BARS]
    if not shown:
        return element("p", nothing, class_="quiet")
    top = 1.05 * max(max(each.cdr, each.floor or 0.0) for each in shown) or 1.0
    step = min((WIDTH - LEFT) / len(shown), WIDEST)
    names = [each.name for each in shown]
    bars = [_bar(row, LEFT + nth * step, step, top) for nth, row in enumerate(shown)]
    below = bar_names(names, left=LEFT, top=TOP + TALLEST, step=step)
    left_out = "" if len(shown) == len(measured) else f" The first {MOST_BARS} of {len(measured)}."
    caption = f"{what}, percent; the dark line is what the marks themselves are off by.{left_out}"
    height = TOP + TALLEST + room_for(names, step=step)
    return _figure(caption, WIDTH, height, *_scale(top), *bars, *below)


def shifts(found: Sequence[tuple[float, float]], *, what: str = "Predicted minus marked centre") -> Markup:
    """A dot for each cap where its predicted centre lies from the marked one; the ellipse holds 95 of 100.

    ``what`` the dots are, as the caption says it.
    """
    if len(found) < 3:
        told = "Fewer than three caps were measured, too few to show how centres shift."
        return element("p", told, class_="quiet")
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
    if further := len(moves) - len(inside):
        caption += " 1 lies further out." if further == 1 else f" {further} lie further out."
    return _figure(caption, SIDE, SIDE, *axes, *dots, _ellipse(moves, scale), cross)


def _figure(caption: str, width: int, height: int, *drawn: Markup) -> Markup:
    svg = element(
        "svg",
        *drawn,
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {width} {height}",
        width=width,
        height=height,
        role="img",
        aria_label=caption,
    )
    return element("figure", svg, element("figcaption", caption))


def _bar(row: Bar, x: float, step: float, top: float) -> Markup:
    mean, floor = row.cdr, row.floor
    told = f"{row.name}: CDR {mean:.3f} %" + ("" if floor is None else f", floor {floor:.3f} %")
    at, wide = _up(mean, top), max(step - 2, 1)
    bar = element(
        "rect", x=round(x, 1), y=at, width=round(wide, 1), height=round(max(_up(0.0, top) - at, 0.0), 1)
    )
    if floor is None:
        return element("g", element("title", told), bar, class_="bar")
    y = _up(floor, top)
    line = element("line", x1=round(x, 1), x2=round(x + wide, 1), y1=y, y2=y, class_="floor")
    return element("g", element("title", told), bar, line, class_="bar")


def _scale(top: float) -> list[Markup]:
    """Round numbers along the left side, with a line across for each."""
    marks = []
    for value in round_numbers(top, most=TICKS):
        y = _up(value, top)
        marks.append(element("line", x1=LEFT, x2=WIDTH, y1=y, y2=y, class_="axis"))
        marks.append(element("text", f"{value:g}", x=LEFT - 6, y=y + 4, class_="number"))
    return marks


def round_numbers(top: float, *, most: int) -> list[float]:
    """From 0 to ``top`` in steps of 1, 2 or 5 times a power of ten; besides 0 at most so many."""
    power = 10.0 ** math.floor(math.log10(top / most))
    step = next(times * power for times in (1, 2, 5, 10) if top / (times * power) <= most)
    return [round(nth * step, 10) for nth in range(int(top / step) + 1)]


def _up(value: float, top: float) -> float:
    """Where a value stands, pixels from above."""
    return round(TOP + TALLEST * (1 - min(value / top, 1.0)), 1)


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
