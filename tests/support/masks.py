"""Masks worked out without any rasteriser."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from pycocotools import mask as pycocotools_mask

Mask = NDArray[np.uint8]


def disc(cx: float, cy: float, r: float, *, height: int = 80, width: int = 100) -> Mask:
    """Pixels whose centres lie in a disc."""
    rows, columns = np.mgrid[:height, :width] + 0.5
    return ((columns - cx) ** 2 + (rows - cy) ** 2 < r * r).astype(np.uint8)


def peppered(mask: Mask, share: float) -> Mask:
    """The mask without this share of its pixels, always the same ones."""
    kept = np.random.default_rng(0).random(mask.shape) > share
    return mask & kept.astype(np.uint8)


def code_of(mask: Mask) -> dict[str, Any]:
    """The mask as COCO's compressed code, by pycocotools."""
    code = pycocotools_mask.encode(np.asfortranarray(mask))
    return {"size": [int(side) for side in code["size"]], "counts": code["counts"].decode()}
