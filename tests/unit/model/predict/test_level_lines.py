"""Outlines drawn between pixels, against the shapes that the logits were made of."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fairyring.model.geometry.raster import mask_of_outline
from fairyring.model.geometry.shapes import area_of_outline, bounds_of_outline, points_of_part
from fairyring.model.predict.level_lines import outline_of_logits


def disc(cx: float, cy: float, r: float, *, height: int = 100, width: int = 100) -> NDArray[np.float32]:
    """Logits that fall by 2 a pixel away from the middle and are 0 on the rim."""
    y, x = np.mgrid[:height, :width] + 0.5
    return (2 * (r - np.hypot(x - cx, y - cy))).astype(np.float32)


def area_and_centroid(part: list[float]) -> tuple[float, float, float]:
    points = points_of_part(part)
    after = np.roll(points, -1, axis=0)
    cross = points[:, 0] * after[:, 1] - after[:, 0] * points[:, 1]
    x, y = ((points + after) * cross[:, None]).sum(axis=0) / (3 * cross.sum())
    return abs(cross.sum()) / 2, x, y


@settings(max_examples=40)
@given(st.floats(48, 52), st.floats(48, 52), st.floats(6, 40))
def test_a_discs_outline_has_its_centre_and_its_size(cx: float, cy: float, r: float) -> None:
    (part,) = outline_of_logits(disc(cx, cy, r), corner=(0, 0))
    area, x, y = area_and_centroid(part)
    assert (x, y) == pytest.approx((cx, cy), abs=0.02)
    assert math.sqrt(area / math.pi) == pytest.approx(r, abs=0.03)


@settings(max_examples=20)
@given(st.floats(48, 52), st.floats(48, 52), st.floats(10, 40))
def test_no_vertex_is_further_from_the_rim_than_the_tolerance(cx: float, cy: float, r: float) -> None:
    (part,) = outline_of_logits(disc(cx, cy, r), corner=(0, 0))
    points = points_of_part(part)
    assert np.hypot(*(points - (cx, cy)).T) == pytest.approx(r, abs=0.2)
    assert len(points) < 80


def test_the_corner_moves_the_outline() -> None:
    logits = disc(30.25, 28.5, 12, height=60, width=60)
    here, there = outline_of_logits(logits, corner=(0, 0)), outline_of_logits(logits, corner=(7, -3))
    moved = points_of_part(here[0]) + np.array([7, -3])
    assert points_of_part(there[0]) == pytest.approx(moved, abs=0.011)


def test_a_straight_edge_runs_where_the_logit_is_nought() -> None:
    logits = np.full((20, 20), -4.0, np.float32)
    # Nought a quarter of the way from the middle of column 5 to that of column 4, and column 14 to 15.
    logits[5:15, 5:15] = 4 / 3
    x, y, width, height = bounds_of_outline(outline_of_logits(logits, corner=(0, 0)))
    assert (x, y, width, height) == pytest.approx((5.25, 5.25, 9.5, 9.5), abs=0.1)


def test_a_cap_at_the_border_reaches_it_but_not_beyond() -> None:
    outline = outline_of_logits(disc(0, 50, 20), corner=(0, 0))
    x, _, width, _ = bounds_of_outline(outline)
    assert 0 <= x < 0.1
    assert x + width == pytest.approx(20, abs=0.1)
    assert area_of_outline(outline) == pytest.approx(math.pi * 200, abs=8)
    everything = outline_of_logits(np.full((10, 12), 9.0, np.float32), corner=(0, 0))
    assert bounds_of_outline(everything) == pytest.approx((0, 0, 12, 10), abs=0.3)


def test_a_hole_stays_one() -> None:
    ring = np.minimum(disc(50, 50, 30), -disc(52, 49, 12))
    outline = outline_of_logits(ring, corner=(0, 0))
    assert len(outline) == 1
    mask = mask_of_outline(outline, height=100, width=100)
    assert not mask[49, 52]
    assert int(mask.sum()) == pytest.approx(math.pi * (900 - 144), rel=0.01)
    assert ((mask != 0) != (ring > 0)).mean() < 0.002


def test_specks_and_pinholes_are_left_out() -> None:
    logits = disc(50, 50, 30)
    logits[50:52, 50:52] = -5
    logits[2:5, 2:5] = 5
    (part,) = outline_of_logits(logits, corner=(0, 0))
    assert area_and_centroid([*part])[0] == pytest.approx(math.pi * 900, rel=0.002)


def test_two_parts_of_one_cap_are_both_there() -> None:
    logits = np.maximum(disc(25, 50, 15), disc(75, 50, 15))
    outline = outline_of_logits(logits, corner=(0, 0))
    assert len(outline) == 2
    assert area_of_outline(outline) == pytest.approx(2 * math.pi * 225, rel=0.003)


@pytest.mark.parametrize("shape", [(0, 0), (0, 5), (6, 0), (1, 1), (8, 8)])
def test_nothing_above_nought_has_no_outline(shape: tuple[int, int]) -> None:
    assert outline_of_logits(np.full(shape, -1.0, np.float32), corner=(3, 4)) == []


def test_a_single_sure_pixel_is_hardly_a_cap() -> None:
    logits = np.full((5, 5), -6.0, np.float32)
    logits[2, 2] = 6
    # A square standing on its corner, with half a pixel of area.
    assert outline_of_logits(logits, corner=(0, 0)) == []


def test_logits_of_nought_in_the_middle_of_pixels_do_no_harm() -> None:
    logits = np.full((12, 12), -2.0, np.float32)
    logits[3:9, 3:9] = 0.0
    logits[4:8, 4:8] = 2.0
    outline = outline_of_logits(logits, corner=(0, 0))
    assert bounds_of_outline(outline) == pytest.approx((3.5, 3.5, 5, 5), abs=0.25)


@settings(max_examples=60)
@given(st.integers(0, 2**32 - 1))
def test_rough_logits_give_outlines_that_rasterise_to_nearly_what_is_above_nought(seed: int) -> None:
    rng = np.random.default_rng(seed)
    coarse = rng.normal(size=(6, 6)).repeat(6, axis=0).repeat(6, axis=1)
    logits = (disc(18, 18, 14, height=36, width=36) + 3 * coarse).astype(np.float32)
    outline = outline_of_logits(logits, corner=(0, 0))
    assert all(len(part) >= 6 and np.isfinite(part).all() for part in outline)
    drawn = mask_of_outline(outline, height=36, width=36) != 0
    assert ((logits > 0) & drawn).sum() / ((logits > 0) | drawn).sum() > 0.85
