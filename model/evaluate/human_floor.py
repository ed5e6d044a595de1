"""The human floor: the CDR that a person's mark has by itself, as no hand places a point exactly.

A predicted centre cannot be shown to be nearer to the truth than this, however good it is.
"""

from __future__ import annotations

import math

MEAN_OF_NOISE = math.sqrt(2 / math.pi)
"""Mean of the absolute value of normal noise, in standard deviations."""


def cdr_of_noise(sd: tuple[float, float], *, width: int, height: int) -> float:
    """Mean CDR, percent (Eq. 10), of a centre that is off by normal noise alone.

    Args:
        sd: one standard deviation along x and y, pixels.
        width: of the image, pixels.
        height: of the image, pixels.
    """
    return 100 * MEAN_OF_NOISE * (sd[0] / width + sd[1] / height)
