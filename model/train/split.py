"""Divides images into training, validation and test by the photo they come from.

The paper augments first and splits afterwards (section 3), so that copies of one photo fall on both sides and
validation measures memory. Here all that comes from one photo stays on one side.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Literal, TypeVar

import numpy as np

Side = Literal["train", "val"]
Name = TypeVar("Name")


def split_by_source(sources: Sequence[str], *, share: float = 0.7, seed: int = 0) -> list[Side]:
    """The side of each item; ``sources`` names the photo each was made from.

    ``share`` of the photos goes to training: the paper's 7:3. The items' order does not matter.
    """
    if not 0 <= share <= 1:
        raise ValueError("share must lie between 0 and 1")
    sides: dict[Side, float] = {"train": share, "val": 1 - share}
    return shared_out(sources, sides, seed=seed)


def shared_out(sources: Sequence[str], shares: Mapping[Name, float], *, seed: int) -> list[Name]:
    """The part of each item, at random; ``sources`` names the photo each was made from.

    Each part gets its share of the photos, of whose sum only the ratio counts, rounded so that all are used.
    The items' order does not matter. Raises ValueError for shares that are negative, or all 0.
    """
    total = sum(shares.values())
    if not total > 0 or not math.isfinite(total) or min(shares.values()) < 0:
        raise ValueError("shares must be 0 or more, and one of them more than 0")
    photos = sorted(set(sources))
    counts = _rounded({name: share / total * len(photos) for name, share in shares.items()})
    names = [name for name, count in counts.items() for _ in range(count)]
    shuffled = np.random.default_rng(seed).permutation(len(photos))
    part = {photos[place]: name for place, name in zip(shuffled, names, strict=True)}
    return [part[source] for source in sources]


def _rounded(exact: Mapping[Name, float]) -> dict[Name, int]:
    """Whole numbers of the same sum: rounded up are those with the largest rest, the first of equals."""
    # Tiny errors of the products must not decide between equals.
    counts = {name: math.floor(value + 1e-9) for name, value in exact.items()}
    left = round(sum(exact.values())) - sum(counts.values())
    for name in sorted(exact, key=lambda name: round(counts[name] - exact[name], 9))[:left]:
        counts[name] += 1
    return counts
