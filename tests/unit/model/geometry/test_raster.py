"""Outlines to masks and run-length codes, with one rasteriser."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from pycocotools import mask as coco

from fairyring.model.geometry.raster import (
    area_of_rle,
    box_of_mask,
    check_rle,
    covered_matrix,
    iou_matrix,
    mask_of_outline,
    mask_of_rle,
    rle_of_mask,
    rle_of_outline,
    shares_inside,
)
from fairyring.model.geometry.shapes import Circle, GeometryError, polygon_of_shape
from tests.support.masks import disc

masks = hnp.arrays(np.uint8, st.tuples(st.integers(1, 14), st.integers(1, 14)), elements=st.integers(0, 1))


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


@given(text=st.text(alphabet=[chr(code) for code in range(48, 112)], max_size=12))
def test_any_text_is_an_rle_or_refused(text: str) -> None:
    try:
        rle = check_rle({"size": [7, 5], "counts": text})
    except GeometryError:
        return
    assert mask_of_rle(rle).shape == (7, 5)


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


def test_the_box_of_a_mask_holds_all_of_it_and_no_empty_row_or_column() -> None:
    mask = np.zeros((7, 9), bool)
    mask[2, 3] = mask[4, 8] = True
    assert box_of_mask(mask) == (slice(2, 5), slice(3, 9))
