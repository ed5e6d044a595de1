"""Masks as outlines that rasterise back to the same pixels."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from fairyring.model.geometry.mask_tracing import outline_of_mask, outline_of_rle
from fairyring.model.geometry.outline_checks import check_outline
from fairyring.model.geometry.raster import mask_of_outline, rle_of_mask
from fairyring.model.geometry.shapes import (
    Ellipse,
    GeometryError,
    area_of_outline,
    points_of_part,
    polygon_of_shape,
)
from tests.support.masks import disc, peppered

RING = np.ones((5, 5), np.uint8)
RING[2, 2] = 0

SLIVERS = mask_of_outline([[19, 13, 0, 15, 23, 23, 0, 0]], height=31, width=31)
"""Once came out wrong: its vertices lay where the rasteriser rounds by the last bit."""

masks = hnp.arrays(np.uint8, st.tuples(st.integers(1, 14), st.integers(1, 14)), elements=st.integers(0, 1))


@given(mask=masks)
@example(mask=np.zeros((3, 4), np.uint8))
@example(mask=np.ones((1, 1), np.uint8))
@example(mask=np.eye(9, dtype=np.uint8))
@example(mask=RING)
@example(mask=SLIVERS)
@example(mask=np.array([[1, 1, 1, 1], [1, 0, 1, 1], [1, 1, 0, 1], [1, 1, 1, 1]], np.uint8))
@settings(max_examples=300)
def test_an_outline_rasterises_back_to_its_mask(mask: np.ndarray) -> None:
    height, width = mask.shape
    outline = outline_of_mask(mask)

    assert np.array_equal(mask_of_outline(outline, height=height, width=width), mask)
    assert outline == (outline_of_rle(rle_of_mask(mask)) if mask.any() else [])


@given(mask=masks.filter(np.any))
@settings(max_examples=200)
def test_a_traced_outline_passes_the_check_with_its_mask_unchanged(mask: np.ndarray) -> None:
    height, width = mask.shape
    checked = check_outline(outline_of_mask(mask), width=width, height=height)

    assert np.array_equal(mask_of_outline(checked, height=height, width=width), mask)


@given(
    a=st.floats(5, 30),
    ratio=st.floats(0.5, 1),
    theta=st.floats(0, 180),
    dx=st.floats(-1, 1),
    dy=st.floats(-1, 1),
)
@settings(max_examples=60)
def test_a_smooth_mask_gets_a_smooth_outline_of_its_own_area(
    a: float, ratio: float, theta: float, dx: float, dy: float
) -> None:
    shape = Ellipse(50 + dx, 40 + dy, a, a * ratio, theta)
    mask = mask_of_outline([polygon_of_shape(shape, chord_error=0.01)], height=80, width=100)

    outline = outline_of_mask(mask)

    (part,) = outline
    assert np.array_equal(mask_of_outline(outline, height=80, width=100), mask)
    assert area_of_outline(outline) == pytest.approx(mask.sum(), abs=1 + 0.02 * 2 * math.pi * a)
    assert len(part) / 2 <= 12 + 0.4 * 2 * math.pi * a
    points = points_of_part(part)
    assert np.hypot(*(points - np.roll(points, 1, axis=0)).T).max() > 1.5, "it follows the pixels' edges"


def test_the_outline_of_a_disc_has_the_disc_s_centre_and_radius() -> None:
    (part,) = outline_of_mask(disc(50.5, 40.5, 30.0))
    x, y = points_of_part(part).T

    assert np.hypot(x - 50.5, y - 40.5).mean() == pytest.approx(30.0, abs=0.1)


def test_pieces_become_parts_and_pieces_that_touch_at_a_corner_stay_one() -> None:
    mask = np.zeros((6, 9), np.uint8)
    mask[1:3, 1:3] = mask[3:5, 3:5] = mask[1:3, 6:8] = 1

    assert len(outline_of_mask(mask)) == 2


def test_pinheads_are_drawn_by_their_pixels() -> None:
    mask = np.zeros((4, 6), np.uint8)
    mask[1, 2:4] = 1

    (part,) = outline_of_mask(mask)

    assert sorted(map(tuple, points_of_part(part).tolist())) == [(2, 1), (2, 2), (4, 1), (4, 2)]


def test_a_hole_survives_in_one_part() -> None:
    mask = disc(50, 40, 30)
    mask[disc(45, 35, 8) == 1] = 0
    mask[disc(60, 50, 5) == 1] = 0

    outline = outline_of_mask(mask)

    assert len(outline) == 1
    assert np.array_equal(mask_of_outline(outline, height=80, width=100), mask)
    assert area_of_outline(outline) == pytest.approx(mask.sum(), rel=0.01)


@given(mask=masks.filter(np.any), dx=st.integers(0, 7), dy=st.integers(0, 7))
@settings(max_examples=100)
def test_a_mask_that_moves_by_whole_pixels_takes_its_outline_along(
    mask: np.ndarray, dx: int, dy: int
) -> None:
    # Away from the border, where outlines are cut off.
    here, there = (np.pad(mask, ((2 + y, 10 - y), (2 + x, 10 - x))) for x, y in ((0, 0), (dx, dy)))

    moved = [np.add(points_of_part(part), (dx, dy)).ravel() for part in outline_of_mask(here)]

    for part, expected in zip(outline_of_mask(there), moved, strict=True):
        assert part == pytest.approx(expected.tolist(), abs=1e-9)


def test_an_outline_at_the_border_stays_in_the_image() -> None:
    mask = disc(2, 78, 20)

    points = np.concatenate([points_of_part(part) for part in outline_of_mask(mask)])

    assert (points >= 0).all()
    assert (points <= (100, 80)).all()


@pytest.mark.parametrize(
    ("rle", "reason"),
    [
        (None, "lacks"),
        ({"counts": [4]}, "lacks"),
        ({"size": [2, 2], "counts": [3]}, "add up"),
        ({"size": [2, 2], "counts": [5]}, "add up"),
        ({"size": [2, 2], "counts": [-1, 5]}, "none below zero"),
        ({"size": [2, 2], "counts": [True, 3]}, "whole numbers"),
        ({"size": [2, 2], "counts": [1.5, 2.5]}, "whole numbers"),
        ({"size": [2, 2], "counts": "zz~"}, "compressed form"),
        ({"size": [2, 2], "counts": "54ü"}, "compressed form"),
        ({"size": [2, 2], "counts": "P"}, "break off"),
        ({"size": [0, 2], "counts": []}, "positive"),
        ({"size": [2, 2, 1], "counts": [4]}, "positive"),
        ({"size": [10**6, 10**6], "counts": [10**12]}, "larger than"),
    ],
)
def test_a_bad_rle_never_reaches_the_decoder(rle: object, reason: str) -> None:
    with pytest.raises(GeometryError, match=reason):
        outline_of_rle(rle)


def test_an_rle_without_pixels_has_no_outline() -> None:
    with pytest.raises(GeometryError, match="no pixel"):
        outline_of_rle({"size": [3, 3], "counts": [9]})


def test_an_rle_is_traced_like_its_mask() -> None:
    mask = disc(50, 40, 30)
    mask[disc(45, 35, 8) == 1] = 0

    assert outline_of_rle(rle_of_mask(mask)) == outline_of_mask(mask)


@pytest.mark.parametrize("share", [0.02, 0.05, 0.2])
def test_the_specks_of_a_noisy_mask_are_left_out_and_counted(share: float) -> None:
    whole = disc(150, 150, 50, height=300, width=300)
    noisy = peppered(whole, share)
    heard: list[str] = []

    (part,) = outline_of_rle(rle_of_mask(noisy), left_out=heard.append)

    assert area_of_outline([part]) == pytest.approx(whole.sum(), rel=0.02)
    # Every hole has a rim of its own: of holes of one pixel, which most are, there are as many as pixels.
    (sentence,) = heard
    missing = whole.sum() - noisy.sum()
    assert 0.3 * missing <= int(sentence.split()[0]) <= missing


def test_a_few_specks_are_no_noise() -> None:
    mask = disc(50, 40, 30)
    mask[30, 40:60:2] = 0
    heard: list[str] = []

    outline = outline_of_rle(rle_of_mask(mask), left_out=heard.append)

    assert np.array_equal(mask_of_outline(outline, height=80, width=100), mask)
    assert heard == []


def test_a_mask_that_is_all_specks_is_refused_or_kept_whole() -> None:
    dots = np.zeros((200, 200), np.uint8)
    dots[::20, ::20] = 1
    assert len(outline_of_rle(rle_of_mask(dots))) == 100

    dots[::4, ::4] = 1
    with pytest.raises(GeometryError, match="2500 pieces and holes"):
        outline_of_rle(rle_of_mask(dots))


def test_pieces_one_around_the_other_are_not_boxed_without_end() -> None:
    rings = (np.indices((1000, 1000)).max(axis=0) % 8 < 4).astype(np.uint8)
    assert len(outline_of_mask(rings[:400, :400])) == 50

    with pytest.raises(GeometryError, match="one around the other"):
        outline_of_mask(np.kron(rings[:400, :400], np.ones((6, 6), np.uint8)))


def test_an_rle_as_large_as_a_photo_may_be_is_not_decoded_for_a_cap() -> None:
    side = 32768
    small = {"size": [side, side], "counts": [side + 1, 5, side * side - side - 6]}
    assert outline_of_rle(small) == [[1, 1, 2, 1, 2, 6, 1, 6]]

    with pytest.raises(GeometryError, match="16384 × 32768 pixels"):
        outline_of_rle({"size": [side, side], "counts": [side * side // 2, side * side // 2]})


def test_noise_is_refused_before_it_is_traced() -> None:
    checks = np.zeros((1000, 1000), np.uint8)
    checks[::2, ::2] = 1
    with pytest.raises(GeometryError, match="rim is longer"):
        outline_of_rle(rle_of_mask(checks))
    with pytest.raises(GeometryError, match="500000 counts"):
        outline_of_rle({"size": [1000, 1000], "counts": [1] * 1_000_000})
    with pytest.raises(GeometryError, match="500000 counts"):
        outline_of_rle({"size": [10000, 10000], "counts": "1" * 100_000_000})


def test_the_numbers_of_an_rle_may_be_written_with_a_point() -> None:
    whole = {"size": [4, 4], "counts": [5, 2, 2, 2, 5]}
    written = {"size": [4.0, 4.0], "counts": [5.0, 2.0, 2.0, 2.0, 5.0]}

    assert outline_of_rle(written) == outline_of_rle(whole)
