"""Caps cut out for the second look."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.model.network.second_look import SIDE
from fairyring.model.predict.looking_again import Opinion, agreed, cut_out
from fairyring.model.predict.overlaps import Window

HEIGHT, WIDTH = 90, 120


def photo() -> NDArray[np.uint8]:
    return np.random.default_rng(1).integers(0, 256, (HEIGHT, WIDTH, 3), dtype=np.uint8)


def block(left: int, top: int, width: int, height: int) -> Window:
    """A cap of this box, surely, in a window with some room around."""
    logits = np.full((height + 4, width + 4), -20, np.float32)
    logits[2:-2, 2:-2] = 20
    return Window(x=left - 2, y=top - 2, logits=logits)


def test_a_window_is_twice_as_wide_as_the_longer_side_of_a_mask() -> None:
    cut = cut_out(photo(), [block(40, 30, 16, 10), block(60, 50, 8, 20)])
    assert cut.places.tolist() == [[48, 35, 16], [64, 60, 20]]


def test_the_layers_are_the_photo_the_cap_and_the_others_pixel_by_pixel() -> None:
    pixels = photo()
    # Of 16 pixels a side the window has as many as it is seen with.
    cut = cut_out(pixels, [block(40, 30, 16, 16), block(56, 30, 10, 16)])
    left, top = 48 - SIDE // 2, 38 - SIDE // 2
    for row in range(SIDE):
        for column in range(SIDE):
            x, y = left + column, top + row
            assert cut.layers[0, :3, row, column] == pytest.approx(pixels[y, x] / 127.5 - 1, abs=1e-5)
            own = float(40 <= x < 56 and 30 <= y < 46)
            assert cut.layers[0, 3, row, column] == pytest.approx(own, abs=1e-5)
            assert cut.layers[0, 4, row, column] == (56 <= x < 66 and 30 <= y < 46)


def test_beyond_the_photo_there_is_nothing() -> None:
    white = np.full((HEIGHT, WIDTH, 3), 255, np.uint8)
    window = block(2, 2, 16, 16)
    (layers,) = cut_out(white, [window]).layers
    beyond = SIDE // 2 - 10
    assert (layers[:3, :beyond] == -1).all()
    assert (layers[:3, :, :beyond] == -1).all()
    assert (layers[:3, beyond:, beyond:] == 1).all()


def test_no_caps_are_cut_into_nothing() -> None:
    cut = cut_out(photo(), [])
    assert (len(cut.layers), cut.places.shape) == (0, (0, 3))


def test_the_quality_of_what_two_passes_saw_leans_towards_how_well_they_agree() -> None:
    whole = LikelyEllipse(parameters=(5.0, 5.0, 1.0, 0.0, 0.0), covariance=())
    said = Opinion(quality=0.9, whole=whole)
    assert agreed(said, None) == said
    assert agreed(said, 0.5) == Opinion(quality=pytest.approx(0.65 * 0.9 + 0.35 * 0.5), whole=whole)
