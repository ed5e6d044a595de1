"""Divides images into training and validation by the photo they come from.

The paper augments first and splits afterwards (section 3), so that copies of one photo fall on both sides and
validation measures memory. Here all that comes from one photo stays on one side.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

Side = Literal["train", "val"]


def split_by_source(sources: Sequence[str], *, share: float = 0.7, seed: int = 0) -> list[Side]:
    """The side of each item; ``sources`` names the photo each was made from.

    ``share`` of the photos, rounded, goes to training: the paper's 7:3. The items' order does not matter.
    """
    if not 0 <= share <= 1:
        raise ValueError("share must lie between 0 and 1")
    photos = sorted(set(sources))
    shuffled = np.random.default_rng(seed).permutation(len(photos))
    training = {photos[index] for index in shuffled[: round(share * len(photos))]}
    return ["train" if source in training else "val" for source in sources]
