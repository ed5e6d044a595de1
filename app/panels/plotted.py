"""What the plots of a review show: their columns, and what each of their points is of."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fairyring.model.evaluate.spread import ellipse_of_spread, reach_of
from fairyring.storage.compared_caps import CapFigures
from fairyring.storage.comparisons import ComparisonRow
from fairyring.storage.review_figures import Shift

Columns = tuple[NDArray[np.float64], ...]


@dataclass(frozen=True, kw_only=True)
class Point:
    """A point of a plot, and what it is of."""

    x: float
    y: float
    image: int
    annotation: str | None
    words: str


@dataclass(frozen=True, kw_only=True)
class Plot:
    """What a plot shows; nothing where it has no points."""

    columns: Columns = ()
    """x, then a column (n,) for each series; NaN where it has no value."""
    points: Sequence[Point] = ()
    x: tuple[float, float] = (0.0, 1.0)
    """Ends of the axis."""
    y: tuple[float, float] = (0.0, 1.0)
    beyond: int = 0
    """How many points lie beyond its edges."""


def plot_of_images(rows: Sequence[ComparisonRow]) -> Plot:
    """Mean CDR of each image by name, its floor and its worst cap."""
    figures = [row.comparison for row in rows]
    names = ("cdr_mean", "floor_mean", "cdr_worst")
    means, floors, worst = (_column(getattr(each, name) for each in figures) for name in names)
    points = [
        Point(
            x=nth,
            y=f.cdr_mean or 0.0,
            image=f.image,
            annotation=f.worst,
            words=f"{nth}, {row.file_name}: CDR {f.cdr_mean:.3f} %{_floor(f.floor_mean)}",
        )
        for nth, (row, f) in enumerate(zip(rows, figures, strict=True), start=1)
    ]
    return _by_number(points, means, floors, worst)


def plot_of_caps(caps: Sequence[CapFigures], *, only_sure: bool = False) -> Plot:
    """CDR of each measured cap of an image with the floor of its mark, as the paper's Figure 19 has it.

    Args:
        caps: all of an image, in the order in which they were made, by which they are numbered.
        only_sure: leaves out doubtful caps and marks that hardly determine a centre.
    """
    numbered = [
        (nth, each)
        for nth, each in enumerate(caps, start=1)
        if each.cdr is not None and not (only_sure and (each.unsure or each.doubtful))
    ]
    measured = [each for _, each in numbered]
    cdr, floors = _column(each.cdr for each in measured), _column(each.floor for each in measured)
    points = [
        Point(
            x=nth,
            y=each.cdr or 0.0,
            image=each.image,
            annotation=each.annotation,
            words=f"cap {nth}: CDR {each.cdr:.3f} %{_floor(each.floor)}",
        )
        for nth, each in numbered
    ]
    return _by_number(points, cdr, floors)


def plot_of_shifts(found: Sequence[Shift]) -> Plot:
    """A dot for each cap, and the ellipse that holds 95 of 100 if they scatter normally."""
    if len(found) < 3:
        return Plot()
    moves = np.array([(each.dx, each.dy) for each in found])
    reach = reach_of(moves)
    inside = [each for each in found if abs(each.dx) <= reach and abs(each.dy) <= reach]
    upper, lower = ellipse_of_spread(moves)
    dots = np.array([(each.dx, each.dy) for each in inside]).reshape(-1, 2)
    x = np.concatenate([dots[:, 0], upper[:, 0]])
    nothing, open_ = np.full(len(dots), np.nan), np.full(len(upper), np.nan)
    order = np.argsort(x, kind="stable")
    columns = (
        x,
        np.concatenate([dots[:, 1], open_]),
        np.concatenate([nothing, upper[:, 1]]),
        np.concatenate([nothing, lower[:, 1]]),
    )
    points = [
        Point(
            x=each.dx,
            y=each.dy,
            image=each.image,
            annotation=each.annotation,
            words=f"Δx {each.dx:+.2f}, Δy {each.dy:+.2f} px",
        )
        for each in inside
    ]
    # y grows downwards on a photo, so it does here.
    return Plot(
        columns=tuple(each[order] for each in columns),
        points=points,
        x=(-reach, reach),
        y=(reach, -reach),
        beyond=len(found) - len(inside),
    )


def further_out(count: int) -> str:
    """How many points lie beyond the edges of a plot."""
    return "1 lies further out." if count == 1 else f"{count} lie further out."


def _by_number(points: Sequence[Point], *columns: NDArray[np.float64]) -> Plot:
    if not points:
        return Plot()
    top = max(float(np.nanmax(np.concatenate([np.zeros(1), *columns]))), 0.01)
    numbers = np.array([each.x for each in points], np.float64)
    ends = (float(numbers[0]) - 0.5, float(numbers[-1]) + 0.5)
    return Plot(columns=(numbers, *columns), points=points, x=ends, y=(0.0, 1.05 * top))


def _column(values: Iterable[float | None]) -> NDArray[np.float64]:
    return np.array([np.nan if value is None else value for value in values], np.float64)


def _floor(floor: float | None) -> str:
    return ", floor not known" if floor is None else f", floor {floor:.3f} %"
