"""Centres against the truth: matching, Eq. 10, and what is ignored."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.evaluate.centres import centre_error, compare, summarise
from fairyring.model.evaluate.pages import CapRecord
from fairyring.model.geometry.raster import rle_of_mask

WIDTH, HEIGHT = 200, 100


def box(x: int, y: int, w: int, h: int) -> dict[str, Any]:
    mask = np.zeros((HEIGHT, WIDTH), np.uint8)
    mask[y : y + h, x : x + w] = 1
    return rle_of_mask(mask)


def cap(x: int, y: int, w: int = 20, h: int = 20, **other: Any) -> CapRecord:
    """A square cap with its centre in the middle."""
    return CapRecord(rle=box(x, y, w, h), **{"centre": (x + w / 2, y + h / 2), "diameter": 20.0, **other})


def compared(truths: list[CapRecord], predictions: list[CapRecord]) -> Any:
    return compare(truths, predictions, width=WIDTH, height=HEIGHT)


def test_cdr_is_equation_10_in_percent_beside_pixels_and_diameters() -> None:
    error = centre_error((103.0, 46.0), (100.0, 50.0), width=200, height=100, diameter=25)

    # |3| / 200 + |-4| / 100 = 1.5 % + 4 %; the hypotenuse of 3 and 4 is 5; 5 / 25.
    assert (error.cdr, error.px, error.relative) == pytest.approx((5.5, 5.0, 0.2))
    assert (error.dx, error.dy) == (3.0, -4.0)


def test_pairs_are_made_by_mask_and_measured_by_centre() -> None:
    found = compared([cap(10, 10), cap(100, 50)], [cap(101, 50), cap(10, 12)])

    assert {(pair.truth, pair.prediction) for pair in found.pairs} == {(0, 1), (1, 0)}
    errors = {pair.truth: pair.error for pair in found.pairs}
    assert (errors[0].dx, errors[0].dy) == (0, 2)
    assert (errors[1].dx, errors[1].dy) == (1, 0)
    assert (found.missed, found.extra) == ([], [])


def test_half_an_overlap_makes_a_pair_and_less_does_not() -> None:
    # 20 × 20 against the same shifted by 6: 280 / 520 = .54; by 7: 260 / 540 = .48.
    assert len(compared([cap(10, 10)], [cap(16, 10)]).pairs) == 1
    found = compared([cap(10, 10)], [cap(17, 10)])
    assert (found.pairs, found.missed, found.extra) == ([], [0], [0])


def test_the_best_of_several_predictions_gets_the_cap_and_the_others_are_extra() -> None:
    found = compared([cap(10, 10)], [cap(12, 10), cap(11, 10), cap(13, 10)])

    assert [(pair.truth, pair.prediction) for pair in found.pairs] == [(0, 1)]
    assert found.extra == [0, 2]


def test_an_unmarked_cap_is_matched_but_has_no_error() -> None:
    found = compared([cap(10, 10, centre=None)], [cap(10, 10)])

    assert len(found.pairs) == 1
    assert found.errors == []


def test_predictions_in_ignored_regions_are_dropped_once_the_others_are_matched() -> None:
    truths = [cap(10, 10), cap(10, 10, 40, 40, ignored=True)]
    predictions = [
        cap(10, 10),  # the real cap's, though it lies in the ignored region
        cap(25, 25),  # wholly inside: dropped
        cap(40, 20),  # half inside: dropped
        cap(41, 20),  # 9 of 20 columns inside: extra
    ]

    found = compared(truths, predictions)

    assert [(pair.truth, pair.prediction) for pair in found.pairs] == [(0, 0)]
    assert found.extra == [3]
    assert found.missed == []


def test_an_ignored_cap_is_never_missed_and_takes_no_partner() -> None:
    found = compared([cap(10, 10, ignored=True)], [cap(10, 10)])

    assert (found.pairs, found.missed, found.extra) == ([], [], [])


def test_an_image_without_caps_or_predictions_is_compared_too() -> None:
    assert compared([], []).pairs == []
    assert compared([], [cap(1, 1)]).extra == [0]
    assert compared([cap(1, 1)], []).missed == [0]


@given(
    places=st.lists(st.tuples(st.integers(0, 150), st.integers(0, 60)), max_size=5),
    guesses=st.lists(st.tuples(st.integers(0, 150), st.integers(0, 60)), max_size=5),
)
@settings(max_examples=60)
def test_every_cap_is_paired_or_missed_once(
    places: list[tuple[int, int]], guesses: list[tuple[int, int]]
) -> None:
    found = compared([cap(*place) for place in places], [cap(*guess) for guess in guesses])

    assert sorted([*(pair.truth for pair in found.pairs), *found.missed]) == list(range(len(places)))
    assert sorted([*(pair.prediction for pair in found.pairs), *found.extra]) == list(range(len(guesses)))


def test_figures_over_caps_are_mean_median_and_95th_percentile() -> None:
    errors = [
        centre_error((x, 0.0), (0.0, 0.0), width=100, height=100, diameter=diameter)
        for x, diameter in [(1.0, 10.0), (2.0, 10.0), (3.0, None), (-10.0, 20.0)]
    ]

    summary = summarise(errors)

    assert summary.cdr.mean == pytest.approx(4.0)
    assert summary.cdr.median == pytest.approx(2.5)
    # Between 3 and 10 at rank 0.95 · 3 = 2.85.
    assert summary.px.p95 == pytest.approx(3 + 0.85 * 7)
    assert summary.relative.mean == pytest.approx((0.1 + 0.2 + 0.5) / 3)
    assert summary.bias_px == pytest.approx((-1.0, 0.0))


def test_nothing_to_average_gives_none() -> None:
    summary = summarise([])
    assert (summary.cdr.mean, summary.px.p95, summary.bias_px) == (None, None, None)
