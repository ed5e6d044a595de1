"""The passes of the network over a photo: at the scale that it knows, and enlarged for small caps.

The photo at the former is the *scaled photo*: all passes are brought together there.
"""

from __future__ import annotations

import math

import cv2
import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from fairyring.model.network.config import FRAME
from fairyring.model.photo import Pixels
from fairyring.model.predict.overlaps import Window
from fairyring.model.predict.tiles import OVERLAP

KNOWN = (35.0, 75.0)
"""Diameters of a photo's middling caps that the network reads well, pixels of what it is given."""
WIDER = 1.6
"""A cap may be so many times as long as a circle of its visible area is wide."""
BEST = 50.0
"""The diameter that others are brought to."""


class Pass(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One pass over a scaled photo, and which caps are taken from it."""

    enlarged: float = 1.0
    """Pixels that the network is given for each pixel of the scaled photo."""
    least: float = 0.0
    """Diameter of the smallest caps taken: of a circle of their visible area, scaled photo's pixels."""
    most: float = 1e9
    """Diameter of the largest."""

    @property
    def overlap(self) -> int:
        """How far two pieces of this pass overlap at least, its pixels: more than its caps are wide."""
        return math.ceil(min(self.most * self.enlarged * WIDER, OVERLAP))

    def takes(self, pixels: float, *, slack: float = 1.0) -> bool:
        """Whether caps of so many visible pixels, of the pass itself, are taken; ``slack`` widens this."""
        diameter = (4 * pixels / np.pi) ** 0.5 / self.enlarged
        return self.least / slack <= diameter <= self.most * slack


ONE_PASS = (Pass(),)
TWO_PASSES = (Pass(least=24), Pass(enlarged=1.5, most=48))
"""Caps of 24 to 48 pixels are taken from both, brought together."""


def first_scale(width: int, height: int) -> float:
    """The scale for a photo whose caps are not known yet: at which it is no wider than FRAME."""
    return min(1.0, FRAME / max(width, height))


def scale_for(diameter: float, *, otherwise: float, best: float = BEST) -> float:
    """The scale that makes caps so many pixels wide ``best`` ones; ``otherwise`` if that will do."""
    return otherwise if KNOWN[0] <= diameter * otherwise <= KNOWN[1] else best / diameter


def resized(photo: Pixels, scale: float) -> Pixels:
    """The photo (height, width, 3) at a scale, at least a pixel a side."""
    height, width = photo.shape[:2]
    size = max(1, round(width * scale)), max(1, round(height * scale))
    if size == (width, height):
        return photo
    way = cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC
    return np.asarray(cv2.resize(photo, size, interpolation=way), np.uint8)


def shrunk(window: Window, *, enlarged: float) -> Window:
    """A window of an enlarged pass with its logits at the pixels of the scaled photo."""
    if enlarged == 1:
        return window
    height, width = window.logits.shape
    left, columns = _places(window.x, width, enlarged)
    top, rows = _places(window.y, height, enlarged)
    grid = np.meshgrid(columns, rows)
    logits = cv2.remap(window.logits, *grid, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return Window(x=left, y=top, logits=np.asarray(logits, np.float32))


def _places(first: int, length: int, enlarged: float) -> tuple[int, NDArray[np.float32]]:
    """The scaled photo's first pixel along an axis, and where the middles of its pixels lie in the window."""
    start, stop = int(np.floor(first / enlarged)), int(np.ceil((first + length) / enlarged))
    middles = (np.arange(start, stop) + 0.5) * enlarged
    return start, (middles - first - 0.5).astype(np.float32)
