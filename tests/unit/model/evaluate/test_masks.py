"""The figures of ``evaluate masks`` on squares, worked out by hand."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.evaluate.caps import CapRecord
from tests.support.squares import cap, scores


def test_the_figures_of_four_caps_are_those_worked_out_by_hand() -> None:
    truths = [cap(0, 0), cap(100, 0), cap(200, 0), cap(300, 0)]
    predictions = [
        cap(0, 0, score=0.9),
        cap(110, 0, score=0.8),  # 30 of 50 columns: IoU .6
        cap(100, 120, score=0.7),  # nothing there
        cap(200, 0, score=0.4),
    ]

    found = scores(truths, predictions)

    assert (found.p, found.r) == (2 / 3, 2 / 4)
    assert (found.s50, found.s75, found.s50_strict, found.s50_small) == (0.5, 0.25, 0.5, None)
    # Taking 1, 2, 3 and 4 predictions: F1 = 2/5, 4/6, 4/7, 6/8.
    best = found.best_f1
    assert (best.f1, best.score, best.p, best.r) == (0.75, 0.4, 0.75, 0.75)
    # Precision from the right: 1 up to recall .5 (51 of the 101 recalls), .75 up to .75, then nothing.
    assert found.ap50 == pytest.approx((51 + 25 * 0.75) / 101)
    # At IoU .75 the second one is wrong too: 1 up to recall .25, 2 of 4 up to .5.
    assert found.ap75 == pytest.approx((26 + 25 * 0.5) / 101)
    # IoU .6 counts at .5, .55 and .6.
    assert found.ar == pytest.approx((3 * 0.75 + 7 * 0.5) / 10)
    counts = found.counts
    assert (counts.truths, counts.predictions, counts.matched, counts.missed, counts.extra) == (4, 4, 2, 2, 1)


def test_perfect_predictions_get_every_figure_right() -> None:
    truths = [cap(0, 0), cap(100, 100, 20, 20), cap(200, 0, 100, 100)]

    found = scores(truths, truths)

    assert (found.ap, found.ap50, found.ap75, found.ar, found.p, found.r) == (1,) * 6
    assert (found.s50, found.s75, found.s50_strict, found.s50_small, found.best_f1.f1) == (1,) * 5


def test_predictions_in_ignored_regions_are_dropped_once_the_others_are_matched() -> None:
    truths = [cap(0, 0), cap(0, 0, 80, 80, ignored=True)]
    predictions = [
        cap(0, 0, score=0.9),  # the real cap's, though it lies in the ignored region
        cap(40, 40, score=0.8),  # wholly inside: dropped
        cap(60, 40, score=0.8),  # half inside: dropped
        cap(61, 0, score=0.8),  # 19 of 40 columns inside: extra
    ]

    found = scores(truths, predictions)

    assert (found.counts.matched, found.counts.dropped, found.counts.extra) == (1, 2, 1)
    assert (found.p, found.r, found.s50, found.counts.ignored) == (0.5, 1, 1, 1)
    # The one in the ignored region alone costs no precision, however sure it is.
    assert scores(truths, [cap(0, 0, score=0.5), cap(40, 40, score=0.9)]).ap == 1
    assert scores(truths, [cap(0, 0, score=0.5), cap(40, 40, score=0.9)]).best_f1.f1 == 1
    assert scores(truths[:1], [cap(0, 0, score=0.5), cap(40, 40, score=0.9)]).ap == pytest.approx(0.5)


def test_an_ignored_cap_is_neither_found_nor_missed() -> None:
    found = scores([cap(0, 0, ignored=True)], [cap(0, 0)])

    assert (found.p, found.r, found.s50, found.ap, found.counts.dropped) == (None, None, None, None, 1)


def test_a_cap_found_twice_is_found_but_not_strictly() -> None:
    found = scores([cap(0, 0), cap(100, 0)], [cap(0, 0), cap(5, 0, score=0.6), cap(100, 0)])
    assert (found.s50, found.s50_strict, found.p) == (1, 0.5, 2 / 3)

    unsure = scores([cap(0, 0)], [cap(0, 0), cap(5, 0, score=0.4)])
    assert unsure.s50_strict == 1


def test_a_fragment_that_covers_less_than_half_of_a_found_cap_costs_precision_alone() -> None:
    assert scores([cap(0, 0)], [cap(0, 0), cap(0, 0, 19, 40)]).s50_strict == 1
    assert scores([cap(0, 0)], [cap(0, 0), cap(0, 0, 19, 40)]).p == 0.5
    assert scores([cap(0, 0)], [cap(0, 0), cap(0, 0, 20, 40)]).s50_strict == 0


def test_a_dropped_prediction_is_no_duplicate() -> None:
    truths = [cap(0, 0), cap(0, 0, 40, 80, ignored=True)]

    assert scores(truths, [cap(0, 0), cap(0, 0, 40, 60, score=0.8)]).s50_strict == 1


def test_one_prediction_over_two_caps_finds_one_of_them_and_neither_strictly() -> None:
    # IoU .5 with each of two alike, .8 with the larger of two.
    alike = scores([cap(0, 0), cap(40, 0)], [cap(0, 0, 80, 40)])
    assert (alike.s50, alike.s50_strict, alike.counts.extra) == (0.5, 0, 0)

    unlike = scores([cap(0, 0, 80, 40), cap(80, 0, 20, 40)], [cap(0, 0, 100, 40)])
    assert (unlike.counts.matched, unlike.s50_strict, unlike.groups["size"]["m"].s75) == (1, 0, 1)

    less_than_half_of_the_second = scores([cap(0, 0), cap(40, 0)], [cap(0, 0, 59, 40)])
    assert less_than_half_of_the_second.s50_strict == 0.5


def test_a_prediction_over_two_caps_that_are_found_too_leaves_neither_strictly_found() -> None:
    found = scores([cap(0, 0), cap(40, 0)], [cap(0, 0), cap(40, 0), cap(0, 0, 80, 40, score=0.7)])

    assert (found.s50, found.s50_strict) == (1, 0)


def test_where_nothing_is_predicted_caps_are_missed_and_precision_is_unknown() -> None:
    found = scores([cap(0, 0)], [])

    assert (found.p, found.r, found.s50, found.ap, found.ar) == (None, 0, 0, 0, 0)
    assert found.best_f1.score is None


def test_where_nothing_is_to_be_found_every_prediction_is_extra() -> None:
    found = scores([], [cap(0, 0)])

    assert (found.p, found.r, found.s50, found.ap, found.counts.extra) == (0, None, None, None, 1)
    assert scores([], []).p is None


def test_the_best_threshold_takes_all_predictions_of_one_score() -> None:
    truths = [cap(0, 0), cap(100, 0)]

    best = scores(truths, [cap(0, 0, score=0.8), cap(200, 0, score=0.8), cap(100, 0, score=0.2)]).best_f1

    assert (best.f1, best.score, best.p, best.r) == (0.8, 0.2, 2 / 3, 1)
    best = scores(truths, [cap(0, 0, score=0.8), cap(200, 0, score=0.8)]).best_f1
    assert (best.f1, best.score) == (0.5, 0.8)


def test_the_surer_prediction_takes_the_cap_and_the_better_one_is_extra() -> None:
    # At IoU .6 and 1; at least .75 only the second one is a partner at all.
    found = scores([cap(0, 0)], [cap(10, 0, score=0.9), cap(0, 0, score=0.4)])

    assert (found.s50, found.p, found.s75) == (1, 1, 0)
    assert found.ap50 == 1


placed = st.builds(cap, st.integers(0, 60), st.integers(0, 30), score=st.sampled_from([0.2, 0.5, 0.7, 1.0]))


@given(
    truths=st.lists(placed, max_size=5),
    predictions=st.lists(placed, max_size=5),
    ignored=st.lists(st.builds(cap, st.integers(0, 60), st.just(0), ignored=st.just(True)), max_size=2),
)
@settings(max_examples=80)
def test_the_figures_agree_with_each_other(
    truths: list[CapRecord], predictions: list[CapRecord], ignored: list[CapRecord]
) -> None:
    found = scores([*truths, *ignored], predictions)

    counts = found.counts
    firm = sum(prediction.score >= 0.5 for prediction in predictions)
    assert counts.matched + counts.missed == counts.truths == len(truths)
    assert counts.matched + counts.extra + counts.dropped == firm
    # All caps are of 45 px here.
    assert found.s50 == found.r
    if found.s50 is not None:
        assert found.s50_strict <= found.s50
        assert found.s75 <= found.s50
    if found.p and found.r:
        assert found.best_f1.f1 >= 2 * found.p * found.r / (found.p + found.r) - 1e-12
