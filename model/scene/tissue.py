"""What clusters grow out of: flesh in which the feet of their stalks are fused, in sight in the gaps."""

from __future__ import annotations

import cv2
import numpy as np

from fairyring.model.scene import textures
from fairyring.model.scene.pixels import Image, lay_over, planes, step
from fairyring.model.scene.skin import STALK, WHITE
from fairyring.model.scene.soil import Bare
from fairyring.model.scene.stalks import Stalk

COARSE = 4
"""It is heaped up on a grid of this many pixels."""
SPREAD = 1.25
"""How far a foot heaps it up around itself: standard deviation, in half widths of the stalk."""
HEIGHT = 24.0
"""Of it over the soil where feet stand close, px."""


def raise_tissue(bare: Bare, stalks: list[Stalk], *, amount: float, rng: np.random.Generator) -> Image:
    """Lays tissue between the feet of ``stalks`` over the soil; returns its share of every pixel.

    A lone foot has hardly any; where several stand close, what they heap up adds up and fills the gap.
    """
    rows, columns = bare.z.shape
    heap = cv2.resize(_heap(stalks, rows, columns), (columns, rows), interpolation=cv2.INTER_CUBIC)
    left, top = rng.integers(0, textures.SIZE // 2, 2)
    y, x = np.mgrid[top : top + rows, left : left + columns].astype(np.float32)
    knobs = textures.look_up(textures.cloud(), 2 * x, 2 * y)
    share = step(0.85, 1.15, amount * heap * (1 + 0.12 * knobs))
    height = share * (HEIGHT * np.minimum(heap, 2) / 2 + 2.5 * knobs)
    bare.normal[0] -= cv2.Sobel(height, cv2.CV_32F, 1, 0, ksize=3, scale=1 / 8)
    bare.normal[1] -= cv2.Sobel(height, cv2.CV_32F, 0, 1, ksize=3, scale=1 / 8)
    bare.z[:] += height
    lay_over(bare.colour, (0.96 + 0.03 * knobs) * planes(WHITE * STALK), share)
    return share


def _heap(stalks: list[Stalk], rows: int, columns: int) -> Image:
    """Sum of what every foot heaps up, 1 in its middle, on the coarse grid."""
    heap = np.zeros((-(-rows // COARSE), -(-columns // COARSE)), np.float32)
    for stalk in stalks:
        spread = SPREAD * stalk.wide / COARSE
        x, y = stalk.foot[0] / COARSE - 0.5, stalk.foot[1] / COARSE - 0.5
        reach = 2.5 * spread
        left, right = max(int(x - reach), 0), min(int(x + reach) + 2, heap.shape[1])
        top, bottom = max(int(y - reach), 0), min(int(y + reach) + 2, heap.shape[0])
        if left < right and top < bottom:
            across = np.exp(-(((np.arange(left, right) - x) / spread) ** 2) / 2)
            down = np.exp(-(((np.arange(top, bottom) - y) / spread) ** 2) / 2)
            heap[top:bottom, left:right] += np.outer(down, across).astype(np.float32)
    return heap
