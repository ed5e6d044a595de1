"""How far outlines stray, on masks whose distances can be counted."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from fairyring.model.evaluate.excursions import strays, worst_deviation
from fairyring.model.geometry.raster import rle_of_mask
from tests.support.masks import Mask, disc
from tests.support.squares import cap, scores


def square() -> Mask:
    """40 × 40 pixels from (20, 20) on: the circle of that area measures 45.1 px, 6 % of it 2.7 px."""
    mask = np.zeros((80, 100), np.uint8)
    mask[20:60, 20:60] = 1
    return mask


def by_loops(first: NDArray[np.uint8], second: NDArray[np.uint8]) -> float:
    """Hausdorff's distance of the rims, each pixel with each."""
    rims = []
    for mask in (first, second):
        around = np.pad(mask, 1)
        held = [
            (row, column)
            for row, column in np.argwhere(mask).tolist()
            if around[row : row + 3, column : column + 3].min() == 0
        ]
        rims.append(np.array(held, float))
    away = np.hypot(*(rims[0][:, None] - rims[1][None]).transpose(2, 0, 1))
    return float(max(away.min(0).max(), away.min(1).max()))


def test_the_worst_deviation_is_that_of_loops_over_all_rim_pixels() -> None:
    pairs = [
        (disc(50, 40, 20), disc(52, 41, 23)),
        (square(), disc(40, 40, 20)),
        (disc(5, 8, 12), disc(0, 0, 14)),
        (square(), square() & ~disc(60, 40, 9)),
    ]
    for first, second in pairs:
        expected = by_loops(first, second)
        assert worst_deviation(rle_of_mask(first), rle_of_mask(second)) == pytest.approx(expected, abs=1e-4)


def test_nothing_deviates_from_itself() -> None:
    assert worst_deviation(rle_of_mask(square()), rle_of_mask(square())) == 0


@pytest.mark.parametrize(("length", "expected"), [(2, False), (3, True)])
def test_a_horn_or_a_notch_of_more_than_six_percent_is_an_excursion(length: int, expected: bool) -> None:
    horned, notched = square(), square()
    horned[40, 60 : 60 + length] = 1
    notched[40, 60 - length : 60] = 0
    assert strays(rle_of_mask(horned), rle_of_mask(square())) is expected
    # A hole of one row: its end is ``length`` pixels inside the true rim.
    assert strays(rle_of_mask(notched), rle_of_mask(square())) is expected


def test_two_pixels_are_allowed_however_small_the_cap() -> None:
    small = disc(50, 40, 6)
    assert not strays(rle_of_mask(disc(50, 40, 7.5)), rle_of_mask(small))
    assert strays(rle_of_mask(disc(50, 40, 9.5)), rle_of_mask(small))


def test_the_shares_are_of_the_caps_that_were_found() -> None:
    truths = [cap(0, 0), cap(100, 0), cap(200, 0), cap(300, 0)]
    predictions = [
        cap(0, 0),
        cap(100, 0, 46, 40),  # 6 px too wide: IoU 40 / 46 = .87
        cap(210, 0),  # IoU .6
        cap(300, 0, score=0.4),  # not certain
    ]
    found = scores(truths, predictions)
    assert (found.iou85, found.excursion) == (2 / 3, 2 / 3)
    assert scores(truths, []).iou85 is None
    sizes = found.groups["size"]
    assert (sizes["m"].excursion, sizes["s"].excursion) == (2 / 3, None)


def test_of_small_caps_outlines_count_too() -> None:
    found = scores([cap(0, 0, 20, 20), cap(100, 0)], [cap(0, 0, 20, 24), cap(100, 0)])
    assert (found.iou85, found.excursion) == (0.5, 0.5)
    assert found.groups["size"]["under_30_px"].excursion == 1
