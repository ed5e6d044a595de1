"""Where anchors stand, and what each of them learns."""

from __future__ import annotations

import pytest
import torch

from fairyring.model.peers.anchors import NEITHER, NOTHING, anchors_of, by_anchor, learnt_by, sampled

CPU = torch.device("cpu")
NOWHERE = torch.zeros(100, 100, dtype=torch.bool)


def test_every_cell_has_three_anchors_of_one_area_about_its_middle() -> None:
    [level] = anchors_of([(2, 3)], strides=[8], sizes=[16.0], device=CPU)
    assert level.shape == (18, 4)
    # The last cell of the first row: its middle lies at (20, 4).
    wide, square, high = level[6:9].tolist()
    assert square == [12, -4, 28, 12]
    assert wide == pytest.approx([20 - 11.3137, 4 - 5.6569, 20 + 11.3137, 4 + 5.6569], abs=1e-3)
    assert high == pytest.approx([20 - 5.6569, 4 - 11.3137, 20 + 5.6569, 4 + 11.3137], abs=1e-3)


def test_what_maps_say_comes_in_the_order_of_the_anchors() -> None:
    shapes, each = [(2, 3), (1, 2)], 2
    levels = []
    for nth, (rows, columns) in enumerate(shapes):
        # Tells of itself: level, cell, anchor, which of its values.
        told = torch.empty(1, 3 * each, rows, columns)
        for row in range(rows):
            for column in range(columns):
                for channel in range(3 * each):
                    anchor, value = divmod(channel, each)
                    cell = row * columns + column
                    told[0, channel, row, column] = 1000 * nth + 100 * cell + 10 * anchor + value
        levels.append(told)
    expected = [
        [1000 * nth + 100 * cell + 10 * anchor + value for value in range(each)]
        for nth, (rows, columns) in enumerate(shapes)
        for cell in range(rows * columns)
        for anchor in range(3)
    ]
    assert by_anchor(levels, each)[0].tolist() == expected


def test_an_anchor_learns_the_cap_it_overlaps_most_or_nothing_or_neither() -> None:
    caps = torch.tensor([[0.0, 0.0, 10.0, 10.0], [40.0, 40.0, 60.0, 60.0]])
    anchors = torch.tensor(
        [
            [0.0, 0.0, 10.0, 9.0],  # .9 of the first
            [0.0, 0.0, 10.0, 20.0],  # .5 of it
            [41.0, 40.0, 61.0, 60.0],  # .9 of the second
            [80.0, 80.0, 90.0, 90.0],
        ]
    )
    learnt = learnt_by(anchors, caps, NOWHERE, cap_from=0.7, nothing_below=0.3, each_cap=False)
    assert learnt.tolist() == [0, NEITHER, 1, NOTHING]


def test_a_cap_that_no_anchor_fits_is_learnt_by_the_nearest_where_each_must_be() -> None:
    caps = torch.tensor([[0.0, 0.0, 4.0, 4.0]])
    anchors = torch.tensor([[0.0, 0.0, 16.0, 16.0], [2.0, 2.0, 18.0, 18.0]])
    alone = {"cap_from": 0.7, "nothing_below": 0.3}
    assert learnt_by(anchors, caps, NOWHERE, **alone, each_cap=True).tolist() == [0, NOTHING]
    assert learnt_by(anchors, caps, NOWHERE, **alone, each_cap=False).tolist() == [NOTHING, NOTHING]


def test_where_nobody_says_what_is_there_an_anchor_does_not_learn_that_nothing_is() -> None:
    ignored = NOWHERE.clone()
    ignored[:50] = True
    anchors = torch.tensor([[10.0, 10.0, 20.0, 20.0], [10.0, 70.0, 20.0, 80.0], [-9.0, -9.0, 1.0, 1.0]])
    learnt = learnt_by(anchors, torch.zeros(0, 4), ignored, cap_from=0.5, nothing_below=0.5, each_cap=True)
    assert learnt.tolist() == [NEITHER, NOTHING, NEITHER]


def test_so_many_are_drawn_and_no_more_than_a_share_of_them_hold_caps() -> None:
    learnt = torch.tensor([0] * 40 + [NOTHING] * 100 + [NEITHER] * 30)
    caps, nothings = sampled(learnt, count=32, most_caps=0.25)
    assert (len(set(caps.tolist())), len(set(nothings.tolist()))) == (8, 24)
    assert set(caps.tolist()) <= set(range(40))
    assert set(nothings.tolist()) <= set(range(40, 140))
    few, rest = sampled(learnt[35:], count=32, most_caps=0.5)
    assert (len(few), len(rest)) == (5, 27)
