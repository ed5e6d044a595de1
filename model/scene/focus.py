"""Depth of field: what lies above or below the plane in focus is blurred as by a thin lens.

The picture is cut into what lies below that plane, about in it, and above it; each is blurred on its own.
What lies below goes on under the edges of the others: a sharp cap keeps its edge before a blurred one.
"""

from __future__ import annotations

import math

import numpy as np

from fairyring.model.scene.pixels import Image, blurred, clipped

UNIT = 150.0
"""Distance below the plane in focus that a blur is given for, px."""
LEAST = 0.25
"""Blur that nobody sees: standard deviation, px."""


def blur_of(z: Image, *, focus: float, distance: float, defocus: float) -> Image:
    """Standard deviation of the blur at view z, px, negative below the plane z = ``focus``.

    A lens of width A, in focus at u0, spreads a point at a distance u over a circle of A (u - u0) / u.
    ``distance`` is the lens's from z = 0, and ``defocus`` the blur UNIT px below the focus.
    """
    apart = distance - focus
    width = defocus * (apart + UNIT) / UNIT
    return (z - focus) * np.float32(width) / (np.float32(distance) - z)


def focused(light: Image, blur: Image, *, sharpness: float) -> Image:
    """Light (3, rows, columns) blurred by ``blur`` (rows, columns), and everywhere by ``sharpness``, px."""
    lowest, *others = [(math.hypot(sharpness, reach), share) for reach, share in _slices(blur)]
    below = blurred(lowest[1], lowest[0])
    before = [blurred(share, reach) for reach, share in others]
    over = np.sum(before, axis=0) if others else np.zeros_like(below)
    # Where none of the lowest is near there is nothing to go on with, and the others make up the whole.
    under = (1 - over).clip(0) / np.maximum(below, 1e-3)
    whole = under * below + over
    planes = []
    for plane in light:
        seen = under * blurred(plane * lowest[1], lowest[0])
        for reach, share in others:
            seen += blurred(plane * share, reach)
        planes.append(seen / whole)
    return np.stack(planes)


def _slices(blur: Image) -> list[tuple[float, Image]]:
    """From below: how far a slice is blurred, and how much of each pixel belongs to it.

    Variances add, so a pixel between two slices has its share of each by the square of its blur.
    """
    below, above = np.percentile(blur[::8, ::8], (2, 99.5)).tolist()
    slices = [(0.0, np.ones_like(blur))]
    if below < -LEAST:
        slices.insert(0, (-below, _share(blur, below)))
    if above > LEAST:
        slices.append((above, _share(blur, above)))
    in_focus = next(share for reach, share in slices if reach == 0)
    for reach, share in slices:
        if reach > 0:
            in_focus -= share
    return slices


def _share(blur: Image, most: float) -> Image:
    """0 in focus and on the other side of it, 1 where the blur is ``most`` or more."""
    share = clipped(blur * np.float32(1 / most), 0, 1)
    share *= share
    return share
