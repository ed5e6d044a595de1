"""Photos of any resolution: how wide their caps are, and seen at the scale that the network knows."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from msgspec import structs
from numpy.typing import NDArray

from fairyring.model.photo import Pixels
from fairyring.model.predict.calibration import uncalibrated
from fairyring.model.predict.passes import Pass, first_scale, resized, scale_for
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.seen import Detection, Seen, SeenPiece
from fairyring.model.predict.tiles import LONGEST, SHORTEST

CERTAIN = 0.5
"""Least score of the caps that are measured."""
ENOUGH = 5
"""So many of them tell their size."""
MOST_TRIES = 4
"""Tries at other scales; after so many the last one is taken."""
LARGEST_STEP = 4.0
"""From one try to the next a photo is not enlarged by more."""


def detect_at_its_scale(
    predictor: Predictor, photo: Pixels, *, diameter: float | None = None
) -> list[Detection]:
    """The caps of a photo of any resolution, in falling order of score; see ``see_at_its_scale``."""
    return predictor.read(see_at_its_scale(predictor, photo, diameter=diameter))


def see_at_its_scale(predictor: Predictor, photo: Pixels, *, diameter: float | None = None) -> Seen:
    """Runs the network on a photo (height, width, 3) uint8 RGB, brought to the scale of its caps.

    ``diameter``: how wide its middling caps are, pixels; looked for in the photo where it is not given.
    """
    height, width = photo.shape[:2]
    if diameter is not None:
        return predictor.see(photo, scale=scale_for(diameter, otherwise=first_scale(width, height)))
    scale, _, pieces = _searched(predictor, photo)
    return predictor.see(photo, scale=scale, seen=pieces)


def diameter_in(predictor: Predictor, photo: Pixels) -> float | None:
    """How wide the middling caps of a photo are, pixels; None where too few are seen at any scale."""
    return _searched(predictor, photo)[1]


def _searched(predictor: Predictor, photo: Pixels) -> tuple[float, float | None, Sequence[SeenPiece]]:
    """The scale for a photo, its caps' diameter, and what was seen of all of it at that scale, if it was."""
    height, width = photo.shape[:2]
    first = scale = first_scale(width, height)
    diameter = None
    for _ in range(MOST_TRIES):
        part = _middle_of(photo, scale)
        pieces = predictor.go_over(resized(part, scale), Pass())
        whole = part.shape == photo.shape
        diameters = _certain_diameters(predictor, pieces)
        if len(diameters) < ENOUGH:
            # Caps too small to be seen may be there; larger ones would have been.
            better = scale * 2
        else:
            diameter = float(np.median(diameters)) / scale
            better = min(scale_for(_weighty(diameters) / scale, otherwise=scale), scale * LARGEST_STEP)
        if better == scale:
            return scale, diameter, pieces if whole else ()
        scale = better
    return (first, None, ()) if diameter is None else (scale_for(diameter, otherwise=first), diameter, ())


def _middle_of(photo: Pixels, scale: float) -> Pixels:
    """The middle of a photo, as much as the network is given at once at this scale."""
    height, width = photo.shape[:2]
    across, down = (LONGEST, SHORTEST) if width >= height else (SHORTEST, LONGEST)
    w, h = min(width, round(across / scale)), min(height, round(down / scale))
    left, top = (width - w) // 2, (height - h) // 2
    return photo[top : top + h, left : left + w]


def _certain_diameters(predictor: Predictor, pieces: Sequence[SeenPiece]) -> NDArray[np.float64]:
    """The diameters of certain caps, of the circles of what is visible, in pixels of the pass, rising."""
    least = uncalibrated(CERTAIN, predictor.calibration)
    settings = structs.replace(predictor.settings.decode, least_score=least)
    stride = predictor.network.config.mask_stride
    pixels = [
        count * stride**2
        for piece in pieces
        for count in (predictor.instances(piece, settings).logits > 0).sum((1, 2)).tolist()
    ]
    return np.sort((4 * np.array(pixels) / np.pi) ** 0.5)


def _weighty(diameters: NDArray[np.float64]) -> float:
    """The diameter at which half of the sum of all, which rise, is reached.

    The scale goes by it: their median would follow buds, of which more are seen the more a photo is enlarged.
    """
    sums = diameters.cumsum()
    return float(diameters[np.searchsorted(sums, sums[-1] / 2)])
