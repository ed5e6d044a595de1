"""Photos of any resolution: how wide their caps are, and seen at the scale that the network knows."""

from __future__ import annotations

import numpy as np
from msgspec import structs
from numpy.typing import NDArray

from fairyring.model.photo import Pixels
from fairyring.model.predict.calibration import uncalibrated
from fairyring.model.predict.passes import BEST, Pass, first_scale, resized, scale_for
from fairyring.model.predict.predictor import Predictor
from fairyring.model.predict.seen import Detection, Seen
from fairyring.model.predict.tiles import LONGEST, SHORTEST

CERTAIN = 0.5
"""Least score of the caps that are measured."""
ENOUGH = 5
"""So many of them tell their size."""
LOOK = 0.5
"""Of the scale a photo would be read at, for the first look at it: there large caps count, not buds."""
WEIGHTY = 60.0
"""The weighty diameter that others are brought to; caps of middling size are about 48 px wide then."""
FROM_AFAR = 1.15
"""Caps come out so much too wide in the first look, which misses small ones (on rendered beds)."""
MOST_LOOKS = 4
"""So often a photo is looked at, each time twice as large, until enough caps are seen."""
MEASURED = (23.0, 100.0)
"""Diameters that are believed, pixels of the look; others are measured in one more look, at another scale."""


def detect_at_its_scale(
    predictor: Predictor, photo: Pixels, *, diameter: float | None = None
) -> list[Detection]:
    """The caps of a photo of any resolution, in falling order of score; see ``see_at_its_scale``."""
    return predictor.read(see_at_its_scale(predictor, photo, diameter=diameter))


def see_at_its_scale(predictor: Predictor, photo: Pixels, *, diameter: float | None = None) -> Seen:
    """Runs the network on a photo (height, width, 3) uint8 RGB, brought to the scale of its caps.

    ``diameter``: how wide its middling caps are, pixels; looked for in the photo where it is not given.
    """
    if diameter is None:
        return predictor.see(photo, scale=_scale_of(predictor, photo))
    height, width = photo.shape[:2]
    return predictor.see(photo, scale=scale_for(diameter, otherwise=first_scale(width, height)))


def diameter_in(predictor: Predictor, photo: Pixels) -> float | None:
    """How wide the middling caps of a photo are, pixels, seen as it is read; None if too few are seen."""
    diameters = _look(predictor, photo, _scale_of(predictor, photo))
    return None if diameters is None else float(np.median(diameters))


def _scale_of(predictor: Predictor, photo: Pixels) -> float:
    height, width = photo.shape[:2]
    first, weighty = first_scale(width, height), _weighty_in(predictor, photo)
    return first if weighty is None else scale_for(weighty, otherwise=first, best=WEIGHTY)


def _weighty_in(predictor: Predictor, photo: Pixels) -> float | None:
    """The diameter by which a photo is scaled, pixels (see ``_weighty``); None if too few caps are seen.

    The look that first shows enough caps decides, but for one more where it shows them very small or large:
    looks that went on would follow ever smaller pinheads, and cut large caps in pieces.
    """
    height, width = photo.shape[:2]
    scale = LOOK * first_scale(width, height)
    for _ in range(MOST_LOOKS):
        if (diameters := _look(predictor, photo, scale)) is not None:
            break
        scale *= 2
    else:
        return None
    weighty = _weighty(diameters)
    if MEASURED[0] <= weighty * scale <= MEASURED[1]:
        return weighty / FROM_AFAR
    again = scale * 2 if weighty * scale < MEASURED[0] else BEST / weighty
    diameters = _look(predictor, photo, again)
    return weighty if diameters is None else _weighty(diameters)


def _look(predictor: Predictor, photo: Pixels, scale: float) -> NDArray[np.float64] | None:
    """The diameters of certain caps at a scale, of circles of what is visible, the photo's pixels, rising.

    None where too few are seen to tell their size.
    """
    diameters = _certain_diameters(predictor, resized(_middle_of(photo, scale), scale)) / scale
    return diameters if len(diameters) >= ENOUGH else None


def _middle_of(photo: Pixels, scale: float) -> Pixels:
    """The middle of a photo, as much as the network is given at once at this scale."""
    height, width = photo.shape[:2]
    across, down = (LONGEST, SHORTEST) if width >= height else (SHORTEST, LONGEST)
    w, h = min(width, round(across / scale)), min(height, round(down / scale))
    left, top = (width - w) // 2, (height - h) // 2
    return photo[top : top + h, left : left + w]


def _certain_diameters(predictor: Predictor, scaled: Pixels) -> NDArray[np.float64]:
    """The diameters of certain caps of a scaled photo, its pixels, rising."""
    least = uncalibrated(CERTAIN, predictor.calibration)
    settings = structs.replace(predictor.settings.decode, least_score=least)
    stride = predictor.network.config.mask_stride
    pixels = [
        count * stride**2
        for piece in predictor.go_over(scaled, Pass())
        for count in (predictor.instances(piece, settings).logits > 0).sum((1, 2)).tolist()
    ]
    return np.sort((4 * np.array(pixels) / np.pi) ** 0.5)


def _weighty(diameters: NDArray[np.float64]) -> float:
    """The diameter at which half of the sum of all, which rise, is reached.

    The scale goes by it: their median would follow buds, of which more are seen the more a photo is enlarged.
    """
    sums = diameters.cumsum()
    return float(diameters[np.searchsorted(sums, sums[-1] / 2)])
