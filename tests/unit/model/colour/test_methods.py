"""Caps found without weights, on drawn discs."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from fairyring.model.colour.bright import bright_pixels, depth_of, flooded, grey_of, peaks_of, usual_diameter
from fairyring.model.colour.methods import METHODS, Found, Method, find_caps
from fairyring.model.geometry.raster import iou_matrix, rle_of_outline
from fairyring.model.geometry.shapes import Circle, area_of_outline, bounds_of_outline, polygon_of_shape

WIDTH, HEIGHT = 360, 240
APART = (
    (60.0, 60.0, 22.0),
    (180.0, 70.0, 26.0),
    (290.0, 60.0, 20.0),
    (90.0, 170.0, 24.0),
    (260.0, 170.0, 25.0),
)
TOUCHING = ((100.0, 100.0, 24.0), (146.0, 100.0, 24.0), (123.0, 141.0, 24.0), (240.0, 120.0, 24.0))


def photo_of(discs: tuple[tuple[float, float, float], ...]) -> NDArray[np.uint8]:
    """Bright discs that darken towards their rims, on dark noise."""
    photo = np.random.default_rng(0).normal(40, 8, (HEIGHT, WIDTH, 3))
    rows, columns = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    for x, y, r in discs:
        away = np.hypot(columns - x, rows - y) / r
        photo[away < 1] = (220 - 50 * away[away < 1] ** 2)[:, None]
    return np.clip(photo, 0, 255).astype(np.uint8)


def likeness(found: list[Found], discs: tuple[tuple[float, float, float], ...]) -> NDArray[np.float64]:
    """(n,) the best IoU that each disc has with what was found."""
    truths = [rle_of_outline([polygon_of_shape(Circle(*disc))], width=WIDTH, height=HEIGHT) for disc in discs]
    seen = [rle_of_outline(each.outline, width=WIDTH, height=HEIGHT) for each in found]
    return iou_matrix(truths, seen).max(1, initial=0)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("diameter", [None, 46.0])
def test_caps_that_lie_apart_are_found_by_every_method(method: Method, diameter: float | None) -> None:
    found = find_caps(photo_of(APART), method, diameter=diameter)
    assert len(found) == len(APART)
    assert likeness(found, APART).min() > 0.7
    assert [one.score for one in found] == sorted((one.score for one in found), reverse=True)
    assert all(0 <= one.score <= 1 for one in found)


@pytest.mark.parametrize("method", ["hough", "watershed"])
def test_caps_that_touch_are_told_apart(method: Method) -> None:
    found = find_caps(photo_of(TOUCHING), method, diameter=48)
    assert len(found) == len(TOUCHING)
    assert likeness(found, TOUCHING).min() > 0.7


@pytest.mark.parametrize("method", METHODS)
def test_a_photo_of_nothing_has_no_caps_and_a_cut_cap_stays_inside(method: Method) -> None:
    assert find_caps(np.zeros((60, 80, 3), np.uint8), method) == []
    assert find_caps(np.full((1, 1, 3), 9, np.uint8), method, diameter=20) == []
    for one in find_caps(photo_of(((5.0, 100.0, 26.0), (180.0, 100.0, 26.0))), method, diameter=52):
        x, y, width, height = bounds_of_outline(one.outline)
        assert x >= 0
        assert y >= 0
        assert x + width <= WIDTH
        assert y + height <= HEIGHT


def test_the_usual_diameter_is_that_of_the_middling_disc() -> None:
    depth = depth_of(bright_pixels(grey_of(photo_of(APART))))
    assert usual_diameter(depth) == pytest.approx(48, rel=0.1)
    assert usual_diameter(np.zeros((20, 20), np.float32)) is None


def test_bright_pixels_are_those_of_the_discs() -> None:
    held = np.count_nonzero(bright_pixels(grey_of(photo_of(APART))))
    assert held == pytest.approx(sum(math.pi * r**2 for *_, r in APART), rel=0.05)


def test_a_plateau_has_one_peak_and_lower_ones_nearby_none() -> None:
    values = np.zeros((30, 40), np.float32)
    values[10:12, 10:13] = 5
    values[11, 15] = 4
    values[20, 30] = 3
    assert peaks_of(values, within=6).tolist() == [[10, 11], [20, 30]]
    assert len(peaks_of(values, within=1)) == 3


def test_an_outline_of_the_watershed_is_where_its_pixels_are() -> None:
    found = find_caps(photo_of(APART[:1]), "watershed", diameter=44)
    (one,) = found
    assert area_of_outline(one.outline) == pytest.approx(math.pi * 22**2, rel=0.12)


def test_flooding_parts_two_hills_where_they_are_lowest() -> None:
    ridge = np.array([1, 3, 6, 8, 5, 3, 2, 4, 7, 9, 4, 0, 2], np.float32)
    parts = flooded(np.tile(ridge, (3, 1)), np.array([[1, 3], [1, 9]]))
    assert parts[1, :6].tolist() == [1] * 6
    assert parts[1, 7:11].tolist() == [2] * 4
    assert parts[1, 11] == 0
    # Nothing leads there from either peak but over what is no bright pixel.
    assert parts[1, 12] == 0
