"""Windows added, taken and cut, against masks of discs."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from fairyring.model.geometry.shapes import Circle, polygon_of_shape
from fairyring.model.predict.added_and_taken import behind, joined, parted, value_at, without
from fairyring.model.predict.overlaps import Window

SIDE = 80


def disc(x: float, y: float, r: float, *, left: int = 0, top: int = 0, side: int = SIDE) -> Window:
    """Logits about the first pixel ``left``, ``top``: 0 on the circle, more inside."""
    rows, columns = np.mgrid[:side, :side] + 0.5
    logits = r - np.hypot(columns + left - x, rows + top - y)
    return Window(x=left, y=top, logits=logits.astype(np.float32))


def held(window: Window) -> NDArray[np.bool_]:
    """The pixels above 0 of a picture of SIDE × SIDE."""
    whole = np.zeros((3 * SIDE, 3 * SIDE), bool)
    height, width = window.logits.shape
    whole[SIDE + window.y : SIDE + window.y + height, SIDE + window.x : SIDE + window.x + width] = (
        window.logits > 0
    )
    return whole


def test_joined_is_either_wherever_their_windows_lie() -> None:
    one, other = disc(20, 20, 10, side=40), disc(60, 40, 15, left=40, top=20, side=40)
    np.testing.assert_array_equal(held(joined(one, other)), held(one) | held(other))
    np.testing.assert_array_equal(held(joined(other, one)), held(one) | held(other))


def test_without_is_one_and_not_the_other() -> None:
    one, other = disc(20, 20, 15, side=40), disc(34, 26, 10, left=20, top=10, side=40)
    np.testing.assert_array_equal(held(without(one, other)), held(one) & ~held(other))
    far = disc(70, 70, 5, left=60, top=60, side=20)
    np.testing.assert_array_equal(held(without(one, far)), held(one))


def test_parted_keeps_what_is_nearer_to_the_kept_points() -> None:
    cap = disc(40, 40, 20)
    rows, columns = np.mgrid[:SIDE, :SIDE] + 0.5
    left = parted(cap, np.array([[30.0, 40.0], [30.0, 50.0]]), np.array([50.0, 40.0]))
    first, second = np.hypot(columns - 30, rows - 40), np.hypot(columns - 30, rows - 50)
    nearer = np.minimum(first, second) < np.hypot(columns - 50, rows - 40)
    expected = np.zeros_like(held(cap))
    expected[SIDE : 2 * SIDE, SIDE : 2 * SIDE] = (cap.logits > 0) & nearer
    np.testing.assert_array_equal(held(left), expected)


def test_a_value_is_that_of_the_pixel_a_point_lies_in() -> None:
    window = disc(40, 40, 20, left=10, top=5, side=60)
    assert value_at(window, np.array([12.9, 7.2])) == window.logits[2, 2]
    assert value_at(window, np.array([9.9, 7.0])) < 0
    assert value_at(window, np.array([75.0, 7.0])) < 0


@pytest.mark.parametrize("x", [40.0, 40.3, 40.5])
def test_caps_in_front_cut_where_their_outline_runs(x: float) -> None:
    """The front cap's left edge is upright: the logits cross 0 between the pixels on either side of it."""
    front = [[x, 0.0, 200.0, 0.0, 200.0, 80.0, x, 80.0]]
    cut = behind(disc(40, 40, 30), [front]).logits[40]
    last = int(np.flatnonzero(cut > 0).max())
    before, after = float(cut[last]), float(cut[last + 1])
    crossing = last + 0.5 + before / (before - after)
    assert crossing == pytest.approx(x, abs=0.3)
    assert (cut[45:] <= -5.9).all()


def test_caps_elsewhere_cut_nothing() -> None:
    window = disc(20, 20, 10, side=40)
    elsewhere = [polygon_of_shape(Circle(200, 200, 30))]
    np.testing.assert_array_equal(behind(window, [elsewhere]).logits, window.logits)
