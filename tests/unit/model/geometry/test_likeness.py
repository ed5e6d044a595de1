"""Outlines that are written otherwise are the same; others are not."""

from __future__ import annotations

import pytest

from fairyring.model.geometry.likeness import are_alike, overlaps

SQUARE = [10.0, 10.0, 30.0, 10.0, 30.0, 30.0, 10.0, 30.0]
TRIANGLE = [40.0, 40.0, 60.0, 40.0, 50.0, 60.0]


@pytest.mark.parametrize(
    "other",
    [
        [SQUARE, TRIANGLE],
        [TRIANGLE, SQUARE],
        [[*SQUARE[4:], *SQUARE[:4]], TRIANGLE],
        [[10.0, 10.0, 10.0, 30.0, 30.0, 30.0, 30.0, 10.0], TRIANGLE],
        [[*SQUARE, 10.0, 10.0], TRIANGLE],
        [[10.004, 9.996, *SQUARE[2:]], TRIANGLE],
    ],
)
def test_another_order_direction_start_or_rounding_is_no_difference(other: list[list[float]]) -> None:
    assert are_alike([SQUARE, TRIANGLE], other)
    assert are_alike(other, [SQUARE, TRIANGLE])


@pytest.mark.parametrize(
    "other",
    [
        [SQUARE],
        [SQUARE, SQUARE],
        [[10.02, 10.0, *SQUARE[2:]], TRIANGLE],
        [[10.0, 10.0, 20.0, 10.0, *SQUARE[2:]], TRIANGLE],
        [],
    ],
)
def test_other_vertices_are_one(other: list[list[float]]) -> None:
    assert not are_alike([SQUARE, TRIANGLE], other)


def test_overlaps_are_shares_of_the_union_of_pairs_that_meet() -> None:
    half = [20.0, 10.0, 40.0, 10.0, 40.0, 30.0, 20.0, 30.0]
    found = overlaps([[SQUARE], [TRIANGLE]], [[half], [SQUARE]], width=100, height=80)
    assert found == {(0, 0): pytest.approx(1 / 3), (0, 1): 1.0}
    assert overlaps([], [[half]], width=100, height=80) == {}
