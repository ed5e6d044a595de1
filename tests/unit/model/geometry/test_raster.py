"""Outlines to masks and back, with one rasteriser."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from pycocotools import mask as coco

from fairyring.model.geometry.raster import (
    area_of_rle,
    check_outline,
    check_rle,
    covered_matrix,
    iou_matrix,
    mask_of_outline,
    mask_of_rle,
    outline_of_mask,
    outline_of_rle,
    rle_of_mask,
    rle_of_outline,
    shares_inside,
)
from fairyring.model.geometry.shapes import (
    Circle,
    Ellipse,
    GeometryError,
    area_of_outline,
    points_of_part,
    polygon_of_shape,
)

RING = np.ones((5, 5), np.uint8)
RING[2, 2] = 0

SLIVERS = mask_of_outline([[19, 13, 0, 15, 23, 23, 0, 0]], height=31, width=31)
"""Once came out wrong: its vertices lay where the rasteriser rounds by the last bit."""

masks = hnp.arrays(np.uint8, st.tuples(st.integers(1, 14), st.integers(1, 14)), elements=st.integers(0, 1))


def disc(cx: float, cy: float, r: float, *, height: int = 80, width: int = 100) -> np.ndarray:
    """Pixels whose centres lie in a disc, worked out without any rasteriser."""
    rows, columns = np.mgrid[:height, :width] + 0.5
    return ((columns - cx) ** 2 + (rows - cy) ** 2 < r * r).astype(np.uint8)


def test_a_pixel_is_covered_when_its_centre_is() -> None:
    mask = mask_of_outline([[1, 1, 3, 1, 3, 2, 1, 2]], height=4, width=5)
    assert np.argwhere(mask).tolist() == [[1, 1], [1, 2]]

    # x from 0.3 to 1.3 covers the centre 0.5 and not 1.5; y from 0.8 to 2.8 covers 1.5 and 2.5.
    mask = mask_of_outline([[0.3, 0.8, 1.3, 0.8, 1.3, 2.8, 0.3, 2.8]], height=4, width=5)
    assert np.argwhere(mask).tolist() == [[1, 0], [2, 0]]


@given(cx=st.floats(30, 70), cy=st.floats(30, 50), r=st.floats(3, 28))
def test_a_circle_covers_the_pixels_within_its_radius(cx: float, cy: float, r: float) -> None:
    drawn = mask_of_outline([polygon_of_shape(Circle(cx, cy, r), chord_error=0.01)], height=80, width=100)

    # The rasteriser works in fifths of a pixel, so only pixels that near the rim may differ.
    assert (drawn >= disc(cx, cy, r - 0.25)).all()
    assert (drawn <= disc(cx, cy, r + 0.25)).all()


@given(mask=masks)
@example(mask=np.zeros((3, 4), np.uint8))
@example(mask=np.ones((1, 1), np.uint8))
@example(mask=np.eye(9, dtype=np.uint8))
@example(mask=RING)
@example(mask=SLIVERS)
@example(mask=np.array([[1, 1, 1, 1], [1, 0, 1, 1], [1, 1, 0, 1], [1, 1, 1, 1]], np.uint8))
@settings(max_examples=300, deadline=None)
def test_an_outline_rasterises_back_to_its_mask(mask: np.ndarray) -> None:
    height, width = mask.shape
    outline = outline_of_mask(mask)

    assert np.array_equal(mask_of_outline(outline, height=height, width=width), mask)
    assert outline == (outline_of_rle(rle_of_mask(mask)) if mask.any() else [])


@given(mask=masks.filter(np.any))
@settings(max_examples=200, deadline=None)
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
@settings(max_examples=60, deadline=None)
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
@settings(max_examples=100, deadline=None)
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


@given(mask=masks)
def test_both_kinds_of_rle_are_read_alike(mask: np.ndarray) -> None:
    flat = mask.ravel(order="F")
    counts, value = [], 0
    while len(flat):
        run = int(np.argmax(flat != value)) if (flat != value).any() else len(flat)
        counts.append(run)
        flat, value = flat[run:], 1 - value
    size = list(mask.shape)

    from_list = check_rle({"size": size, "counts": counts})
    from_text = check_rle(rle_of_mask(mask))
    from_bytes = check_rle(coco.encode(np.asfortranarray(mask)))

    assert from_list == from_text == from_bytes
    assert np.array_equal(mask_of_rle(from_list), mask)


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


@given(text=st.text(alphabet=[chr(code) for code in range(48, 112)], max_size=12))
def test_any_text_is_an_rle_or_refused(text: str) -> None:
    try:
        rle = check_rle({"size": [7, 5], "counts": text})
    except GeometryError:
        return
    assert mask_of_rle(rle).shape == (7, 5)


def test_an_rle_without_pixels_has_no_outline() -> None:
    with pytest.raises(GeometryError, match="no pixel"):
        outline_of_rle({"size": [3, 3], "counts": [9]})


@given(
    first=hnp.arrays(np.uint8, (3, 6, 7), elements=st.integers(0, 1)), second=hnp.arrays(np.uint8, (2, 6, 7))
)
def test_iou_is_intersection_over_union(first: np.ndarray, second: np.ndarray) -> None:
    second = second % 2
    matrix = iou_matrix([rle_of_mask(m) for m in first], [rle_of_mask(m) for m in second])

    for i, a in enumerate(first):
        for j, b in enumerate(second):
            union = (a | b).sum()
            assert matrix[i, j] == pytest.approx((a & b).sum() / union if union else 0)


def test_iou_with_nothing_has_the_shape_of_nothing() -> None:
    one = rle_of_mask(np.ones((2, 2)))
    assert iou_matrix([], [one]).shape == (0, 1)
    assert iou_matrix([one], []).shape == (1, 0)
    with pytest.raises(GeometryError, match="different sizes"):
        iou_matrix([one], [rle_of_mask(np.ones((2, 3)))])


def test_the_share_inside_several_regions_counts_each_pixel_once() -> None:
    mask, left, wide = (np.zeros((1, 10), np.uint8) for _ in range(3))
    mask[0, 2:10], left[0, :4], wide[0, :6] = 1, 1, 1

    shares = shares_inside([rle_of_mask(mask), rle_of_mask(left)], [rle_of_mask(left), rle_of_mask(wide)])

    assert shares == pytest.approx([4 / 8, 1])
    assert shares_inside([rle_of_mask(mask)], []).tolist() == [0]
    assert shares_inside([], [rle_of_mask(left)]).shape == (0,)


def test_what_is_covered_is_a_share_of_the_first_masks() -> None:
    short, long, empty = (np.zeros((1, 10), np.uint8) for _ in range(3))
    short[0, :4], long[0, 3:] = 1, 1

    shares = covered_matrix([rle_of_mask(m) for m in (short, long, empty)], [rle_of_mask(long)])

    assert shares[:, 0] == pytest.approx([1 / 4, 1, 0])


def test_parts_that_overlap_are_united() -> None:
    square = [1, 1, 5, 1, 5, 5, 1, 5]
    assert area_of_rle(rle_of_outline([square, square], height=8, width=8)) == 16


def test_no_parts_cover_nothing_and_two_points_are_no_polygon() -> None:
    assert area_of_rle(rle_of_outline([], height=4, width=4)) == 0
    # pycocotools would take four numbers for a box.
    with pytest.raises(GeometryError, match="three points"):
        rle_of_outline([[0, 0, 3, 3]], height=4, width=4)
