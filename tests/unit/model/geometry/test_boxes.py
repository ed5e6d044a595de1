"""Boxes around outlines, and which of them touch."""

from __future__ import annotations

from fairyring.model.geometry.boxes import NOWHERE, box_of_outline, boxes_of_outlines, touching

LEFT = [[0.0, 0.0, 4.0, 1.0, 2.0, 6.0]]
PARTED = [[4.0, 2.0, 5.0, 2.0, 5.0, 3.0], [9.0, -1.5, 9.5, 0.0, 8.0, 0.5]]
FAR = [[20.0, 20.0, 21.0, 20.0, 21.0, 22.0]]


def test_a_box_holds_every_part() -> None:
    assert box_of_outline(LEFT) == (0, 0, 4, 6)
    assert box_of_outline(PARTED) == (4, -1.5, 9.5, 3)


def test_boxes_that_share_an_edge_touch_and_one_of_nothing_touches_none() -> None:
    assert box_of_outline([]) == box_of_outline([[]]) == NOWHERE
    boxes = boxes_of_outlines([LEFT, PARTED, FAR, []])
    assert touching(boxes, boxes).tolist() == [
        [True, True, False, False],
        [True, True, False, False],
        [False, False, True, False],
        [False, False, False, False],
    ]


def test_no_outlines_have_no_boxes() -> None:
    assert boxes_of_outlines([]).shape == (0, 4)
    assert touching(boxes_of_outlines([]), boxes_of_outlines([FAR])).shape == (0, 1)
