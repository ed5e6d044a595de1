"""CDR as bars with their names below, by image or by cap as the paper's Figure 19 has it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from fairyring.app.panels.markup import Content, Markup, element
from fairyring.app.report.bar_names import bar_names, room_for
from fairyring.app.report.drawing import Drawing, figure_of

WIDTH, TALLEST, LOWER = 720, 224, 120
"""Of a plot, and how high it is where there are several below each other; pixels."""
LEFT, TOP = 48, 8
"""Room for the numbers at the axis, and above the plot."""
WIDEST = 80
"""Of a bar."""
IN_A_ROW, MOST_ROWS = 64, 8
"""More bars in a row leave no room for their names; of more rows nobody sees the whole."""
TICKS = 5
"""So many numbers at an axis at most, besides its zero."""


@dataclass(frozen=True, kw_only=True)
class Bar:
    """The CDR of an image or of a cap, and of its marks alone; percent."""

    name: str
    cdr: float
    floor: float | None


def cdr_bars(
    measured: Sequence[Bar], *, what: str, others: Content, nothing: str = "Nothing was measured."
) -> Markup:
    """A bar for each CDR in the order given, the floor of its marks a line across, in a figure.

    Args:
        measured: the bars.
        what: they are of.
        others: where those stand that are too many to be shown.
        nothing: what is said where there is no bar.
    """
    rows = rows_of_bars(measured, what=what)
    if not rows:
        return element("p", nothing, class_="quiet")
    left = len(measured) - IN_A_ROW * MOST_ROWS
    return figure_of(rows, *((f" The other {left} stand in ", others, ".") if left > 0 else ()))


def rows_of_bars(measured: Sequence[Bar], *, what: str) -> list[Drawing]:
    """The same as drawings to be put below each other, all of one scale; none where there is no bar."""
    shown = measured[: IN_A_ROW * MOST_ROWS]
    top = 1.05 * max((max(each.cdr, each.floor or 0.0) for each in shown), default=0.0) or 1.0
    rows = in_rows(shown)
    tall = TALLEST if len(rows) == 1 else LOWER
    caption = f"{what}, percent; the dark line is what the marks themselves are off by."
    drawn = (_row(row, of=len(rows[0]), top=top, tall=tall) for row in rows)
    return [Drawing(caption=caption, width=WIDTH, height=height, parts=parts) for height, parts in drawn]


def in_rows(bars: Sequence[Bar]) -> list[Sequence[Bar]]:
    """As few rows as have room for the names, all but the last equally long."""
    if not bars:
        return []
    long = math.ceil(len(bars) / math.ceil(len(bars) / IN_A_ROW))
    return [bars[start : start + long] for start in range(0, len(bars), long)]


def _row(bars: Sequence[Bar], *, of: int, top: float, tall: int) -> tuple[int, list[Markup]]:
    """Bars beside each other with their names below, as wide as ``of`` would be; first how high it is."""
    step = min((WIDTH - LEFT) / of, WIDEST)
    names = [each.name for each in bars]
    up = partial(_up, top=top, tall=tall)
    drawn = [_bar(each, LEFT + nth * step, step, up) for nth, each in enumerate(bars)]
    below = bar_names(names, left=LEFT, top=TOP + tall, step=step)
    return TOP + tall + room_for(names, step=step), [*_scale(top, up), *drawn, *below]


def _bar(row: Bar, x: float, step: float, up: Callable[[float], float]) -> Markup:
    mean, floor = row.cdr, row.floor
    told = f"{row.name}: CDR {mean:.3f} %" + ("" if floor is None else f", floor {floor:.3f} %")
    at, wide = up(mean), max(step - 2, 1)
    bar = element("rect", x=round(x, 1), y=at, width=round(wide, 1), height=round(max(up(0.0) - at, 0.0), 1))
    if floor is None:
        return element("g", element("title", told), bar, class_="bar")
    y = up(floor)
    line = element("line", x1=round(x, 1), x2=round(x + wide, 1), y1=y, y2=y, class_="floor")
    return element("g", element("title", told), bar, line, class_="bar")


def _scale(top: float, up: Callable[[float], float]) -> list[Markup]:
    """Round numbers along the left side, with a line across for each."""
    marks = []
    for value in round_numbers(top, most=TICKS):
        y = up(value)
        marks.append(element("line", x1=LEFT, x2=WIDTH, y1=y, y2=y, class_="axis"))
        marks.append(element("text", f"{value:g}", x=LEFT - 6, y=y + 4, class_="number"))
    return marks


def round_numbers(top: float, *, most: int) -> list[float]:
    """From 0 to ``top`` in steps of 1, 2 or 5 times a power of ten; besides 0 at most so many."""
    power = 10.0 ** math.floor(math.log10(top / most))
    step = next(times * power for times in (1, 2, 5, 10) if top / (times * power) <= most)
    return [round(nth * step, 10) for nth in range(int(top / step) + 1)]


def _up(value: float, *, top: float, tall: int) -> float:
    """Where a value stands in a plot that is so ``tall``, pixels from above."""
    return round(TOP + tall * (1 - min(value / top, 1.0)), 1)
