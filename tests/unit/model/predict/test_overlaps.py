"""Pixels that two predicted caps claim."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fairyring.model.predict.overlaps import CONFIDENT, Window, distinct, resolve_overlaps


def window(x: int, y: int, values: list[list[float]]) -> Window:
    return Window(x=x, y=y, logits=np.array(values, np.float32))


def test_a_pixel_goes_to_whoever_is_surer() -> None:
    first = window(0, 0, [[4.0, 3.0, 1.0]])
    second = window(1, 0, [[1.0, 2.5, 4.0]])
    a, b = resolve_overlaps([first, second], [0.9, 0.8], width=5, height=1)
    assert a.logits.tolist() == [[4.0, 2.0, -1.5]]
    assert b.logits.tolist() == [[-2.0, 1.5, 4.0]]


def test_logits_below_nought_take_nothing() -> None:
    a, b = resolve_overlaps(
        [window(0, 0, [[4.0, 1.0]]), window(0, 0, [[-3.0, 2.0]])], [0.9, 0.8], width=2, height=1
    )
    assert a.logits.tolist() == [[4.0, -1.0]]
    assert b.logits.tolist() == [[-7.0, 1.0]]


def test_the_unsure_take_nothing_from_others() -> None:
    unsure = CONFIDENT - 0.01
    a, b = resolve_overlaps([window(0, 0, [[2.0]]), window(0, 0, [[5.0]])], [0.9, unsure], width=1, height=1)
    assert a.logits.tolist() == [[2.0]]
    assert b.logits.tolist() == [[3.0]]


def test_windows_are_cut_to_the_photo() -> None:
    values = np.arange(12, dtype=np.float32).reshape(3, 4).tolist()
    (cut,) = resolve_overlaps([window(-1, 1, values)], [0.9], width=2, height=3)
    assert (cut.x, cut.y) == (0, 1)
    assert cut.logits.tolist() == [[1.0, 2.0], [5.0, 6.0]]


def test_a_window_outside_of_the_photo_is_left_empty() -> None:
    ones = [[1.0, 1.0], [1.0, 1.0]]
    places = [(-2, 0), (5, 0), (9, 9), (0, -7), (0, 4)]
    for cut in resolve_overlaps([window(x, y, ones) for x, y in places], [0.9] * 5, width=5, height=4):
        assert cut.logits.size == 0
        assert 0 <= cut.x <= 5
        assert 0 <= cut.y <= 4


def test_no_windows_resolve_to_none() -> None:
    assert resolve_overlaps([], [], width=4, height=4) == []


def test_a_component_under_half_of_the_largest_is_left_out_and_a_larger_one_kept() -> None:
    cap = window(0, 0, [[1.0] * 6])
    two_parts = [[-1.0, 3.0, -1.0, 3.0, 3.0, 3.0]]
    resolved, thief = resolve_overlaps([cap, window(0, 0, two_parts)], [0.9, 0.8], width=6, height=1)
    assert resolved.logits.tolist() == [[1.0, 1.0, 1.0, -2.0, -2.0, -2.0]]
    assert thief.logits.tolist() == [[-2.0, -4.0, -2.0, 2.0, 2.0, 2.0]]
    wider = [[3.0, 3.0, -1.0, 3.0, 3.0, 3.0]]
    resolved, _ = resolve_overlaps([cap, window(0, 0, wider)], [0.9, 0.8], width=6, height=1)
    assert resolved.logits.tolist() == [[-2.0, -2.0, 1.0, -2.0, -2.0, -2.0]]


def test_what_others_leave_beside_the_largest_part_goes_and_as_large_a_part_stays() -> None:
    beneath = np.ones((1, 9), np.float32)
    over = window(5, 0, [[4.0, 4.0, 4.0]])
    scrap, _ = resolve_overlaps([Window(x=0, y=0, logits=beneath), over], [0.9, 0.9], width=9, height=1)
    assert (scrap.logits[0] > 0).tolist() == [True] * 5 + [False] * 4
    middle = window(3, 0, [[4.0, 4.0, 4.0]])
    halves, _ = resolve_overlaps([Window(x=0, y=0, logits=beneath), middle], [0.9, 0.9], width=9, height=1)
    assert (halves.logits[0] > 0).tolist() == [True] * 3 + [False] * 3 + [True] * 3


def by_loops(
    windows: list[Window], scores: list[float], width: int, height: int
) -> list[NDArray[np.float32]]:
    """Photo-sized logits of each, NaN outside of its window."""
    whole = []
    for one in windows:
        canvas = np.full((height, width), np.nan, np.float32)
        for row, values in enumerate(one.logits):
            for column, value in enumerate(values):
                if 0 <= one.y + row < height and 0 <= one.x + column < width:
                    canvas[one.y + row, one.x + column] = value
        whole.append(canvas)
    resolved = []
    for nth, canvas in enumerate(whole):
        others = [o for m, o in enumerate(whole) if m != nth and scores[m] >= CONFIDENT]
        most = np.nanmax(np.stack([np.zeros_like(canvas), *others]), axis=0)
        resolved.append(canvas - most)
    return resolved


windows = st.tuples(
    st.integers(-4, 8), st.integers(-4, 8), st.integers(1, 5), st.integers(1, 5), st.floats(0.05, 1)
)


@settings(max_examples=60)
@given(st.lists(windows, max_size=5), st.integers(0, 1000))
def test_settling_is_what_loops_make_of_it(drawn: list[tuple[int, int, int, int, float]], seed: int) -> None:
    rng = np.random.default_rng(seed)
    given_windows = [
        Window(x=x, y=y, logits=rng.integers(-3, 6, (h, w)).astype(np.float32)) for x, y, w, h, _ in drawn
    ]
    scores = [score for *_, score in drawn]
    expected = by_loops(given_windows, scores, 8, 7)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            "fairyring.model.predict.overlaps.LEAST_PART", 0.0
        )  # specks, too, as these are nothing else
        resolved = resolve_overlaps(given_windows, scores, width=8, height=7)
    for one, whole in zip(resolved, expected, strict=True):
        height, width = one.logits.shape
        np.testing.assert_array_equal(one.logits, whole[one.y : one.y + height, one.x : one.x + width])
        assert np.isfinite(whole).sum() == one.logits.size


def squares(*corners: tuple[int, int]) -> NDArray[np.bool_]:
    """Masks of 20 × 40 cells with a square of 10 cells a side each."""
    masks = np.zeros((len(corners), 20, 40), bool)
    for mask, (x, y) in zip(masks, corners, strict=True):
        mask[y : y + 10, x : x + 10] = True
    return masks


def test_a_second_view_of_a_cap_is_no_cap_of_its_own() -> None:
    # The second shares 90 of its 100 cells with the first, the third 20.
    assert distinct(squares((2, 2), (3, 2), (10, 2)), [0.9, 0.8, 0.7]) == [0, 2]


def test_half_of_a_cap_may_be_claimed_by_others_and_no_more() -> None:
    for shift, kept in ((5, [0, 1]), (4, [0])):
        assert distinct(squares((2, 2), (2 + shift, 2)), [0.9, 0.8]) == kept


def test_the_unsure_take_no_caps_from_others() -> None:
    unsure = CONFIDENT - 0.01
    assert distinct(squares((2, 2), (2, 2)), [unsure, unsure]) == [0, 1]


def test_an_empty_mask_is_no_cap() -> None:
    masks = squares((2, 2), (2, 2))
    masks[0] = False
    assert distinct(masks, [0.9, 0.8]) == [1]


def disc(x: float, *, side: int = 90) -> NDArray[np.float32]:
    """Logits of a disc of 20 px about (x, 30), 0 on its rim and one more a pixel towards its middle."""
    rows, columns = np.mgrid[:60, :side] + 0.5
    return (20 - np.hypot(columns - x, rows - 30)).astype(np.float32)


@pytest.mark.parametrize("narrow", [1, 2, 3])
def test_no_tongue_of_one_cap_is_left_inside_another(narrow: int) -> None:
    tongued = disc(66)
    tongued[29 : 29 + narrow, 20:46] = 30.0
    cap, other = resolve_overlaps(
        [Window(x=0, y=0, logits=disc(24)), Window(x=0, y=0, logits=tongued)], [0.8, 0.9], width=90, height=60
    )
    np.testing.assert_array_equal(cap.logits > 0, disc(24) > 0)
    # Beside its disc a horn leaves no more than a stub.
    np.testing.assert_array_equal((other.logits > 0)[:, :44], False)
    assert ((other.logits > 0) == (disc(66) > 0))[:, 48:].all()


def test_a_cap_in_front_of_another_keeps_its_pixels() -> None:
    behind, front = disc(30), 60 * np.sign(disc(45))
    cap, other = resolve_overlaps(
        [Window(x=0, y=0, logits=behind), Window(x=0, y=0, logits=front)], [0.9, 0.8], width=90, height=60
    )
    np.testing.assert_array_equal((cap.logits > 0) & (other.logits > 0), False)
    assert (other.logits > 0)[disc(45) > 0].all()
