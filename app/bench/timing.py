"""Timings of repeated work, and the rows in which benchmarks report them."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from typing import Any, TypeVar

import numpy as np

T = TypeVar("T")
Row = dict[str, Any]
"""One line of a benchmark's table: figure, value, unit, target, reference, ratio."""


def milliseconds(work: Callable[[T], object], over: Iterable[T]) -> list[float]:
    """Runs ``work`` on each item; milliseconds that each took."""
    taken = []
    for item in over:
        start = time.perf_counter()
        work(item)
        taken.append((time.perf_counter() - start) * 1e3)
    return taken


def p95_row(
    figure: str, taken: list[float], *, target: float | None = None, reference: list[float] | None = None
) -> Row:
    """The 95th percentile, beside the target and the ratio to the reference's 95th percentile, in ms."""
    value = float(np.percentile(taken, 95))
    plain = None if reference is None else float(np.percentile(reference, 95))
    return row(figure, value, unit="ms p95", target=target, reference=plain)


def row(
    figure: str, value: float, *, unit: str, target: float | None = None, reference: float | None = None
) -> Row:
    """One line; ``ratio`` is the value over the plain reference's, both in the same unit, in three digits."""
    return {
        "figure": figure,
        "value": round(value, 3),
        "unit": unit,
        "target": target,
        "reference": None if reference is None else round(reference, 3),
        "ratio": None if not reference else float(f"{value / reference:.3g}"),
    }
