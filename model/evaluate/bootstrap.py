"""How far a mean over caps may be off by chance, by the bootstrap.

Caps of one photo go wrong together (one light, one focus), so photos are drawn, not caps, as soon as there
are enough of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

RESAMPLES = 2000
SEED = 0
BOUNDS = (2.5, 97.5)
"""Percentiles of the resampled means: an interval of 95 %."""
FEWEST_IMAGES = 10
"""With fewer there are too few ways to draw them."""
MOST_PLACES = 1 << 20
"""How many places are drawn at once."""

Drawn = Literal["images", "caps"]


class Interval(Struct, frozen=True, kw_only=True):
    """The mean of a figure over caps, and between what it lies in 95 of 100 resamples."""

    mean: float
    low: float
    high: float
    drawn: Drawn
    """What was resampled."""
    count: int
    """Number of caps."""


def mean_interval(figures: NDArray[np.float64], images: NDArray[np.int64]) -> Interval | None:
    """The mean of n figures (n,), each of a cap of the image of that number (n,); None without figures.

    The same figures give the same interval.
    """
    if not len(figures):
        return None
    numbers, places = np.unique(images, return_inverse=True)
    random = np.random.default_rng(SEED)
    drawn: Drawn = "images" if len(numbers) >= FEWEST_IMAGES else "caps"
    if drawn == "images":
        sums, counts = np.bincount(places, figures), np.bincount(places)
        means = [sums[some].sum(axis=1) / counts[some].sum(axis=1) for some in _draws(len(sums), random)]
    else:
        means = [figures[some].mean(axis=1) for some in _draws(len(figures), random)]
    low, high = np.percentile(np.concatenate(means), BOUNDS)
    return Interval(
        mean=float(figures.mean()), low=float(low), high=float(high), drawn=drawn, count=len(figures)
    )


def _draws(count: int, random: np.random.Generator) -> Iterator[NDArray[np.int64]]:
    """Resamples of so many things, as places (some, count), a few at a time."""
    at_once = max(1, MOST_PLACES // count)
    for start in range(0, RESAMPLES, at_once):
        yield random.integers(count, size=(min(at_once, RESAMPLES - start), count))
