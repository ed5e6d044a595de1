"""Augmentations move an image and its outlines alike."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fairyring.model.geometry.raster import mask_of_outline
from fairyring.model.geometry.shapes import Ellipse, polygon_of_shape
from fairyring.model.train.augment import (
    Augmentation,
    motion_of,
    move_image,
    move_outline,
    move_points,
    sample_augmentation,
)

WIDTH, HEIGHT = 160, 120

augmentations = st.builds(
    Augmentation,
    flip_horizontal=st.booleans(),
    flip_vertical=st.booleans(),
    rotation_deg=st.floats(-180, 180),
)


@settings(max_examples=40)
@given(augmentations)
def test_a_centre_moves_exactly_with_its_cap(augmentation: Augmentation) -> None:
    cap = Ellipse(71.3, 64.8, 22.0, 15.0, 30.0)
    image = 200 * mask_of_outline([polygon_of_shape(cap, chord_error=0.01)], height=HEIGHT, width=WIDTH)
    motion = motion_of(augmentation, width=WIDTH, height=HEIGHT)
    moved_image = move_image(image, motion, width=WIDTH, height=HEIGHT).astype(float)
    rows, columns = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    mass = np.array([(columns * moved_image).sum(), (rows * moved_image).sum()]) / moved_image.sum()
    before = np.array([(columns * image).sum(), (rows * image).sum()]) / image.sum()
    expected = move_points(before[None], motion)[0]
    assert mass == pytest.approx(expected, abs=0.02)


@pytest.mark.parametrize(("horizontal", "vertical"), [(True, False), (False, True), (True, True)])
def test_mirroring_loses_no_pixel(horizontal: bool, vertical: bool) -> None:
    image = np.random.default_rng(1).integers(0, 256, (HEIGHT, WIDTH, 3), dtype=np.uint8)
    augmentation = Augmentation(flip_horizontal=horizontal, flip_vertical=vertical)
    motion = motion_of(augmentation, width=WIDTH, height=HEIGHT)
    mirrored = move_image(image, motion, width=WIDTH, height=HEIGHT)
    expected = image[:: -1 if vertical else 1, :: -1 if horizontal else 1]
    np.testing.assert_array_equal(mirrored, expected)


def test_an_outline_rasterises_where_the_image_shows_it() -> None:
    outline = [[30.0, 20.0, 90.5, 25.0, 80.0, 70.5, 35.0, 60.0]]
    augmentation = Augmentation(flip_horizontal=True, rotation_deg=17)
    image = 255 * mask_of_outline(outline, height=HEIGHT, width=WIDTH)
    motion = motion_of(augmentation, width=WIDTH, height=HEIGHT)
    shown = move_image(image, motion, width=WIDTH, height=HEIGHT) > 127
    told = mask_of_outline(move_outline(outline, motion), height=HEIGHT, width=WIDTH) != 0
    assert (shown & told).sum() / (shown | told).sum() > 0.98


def test_a_quarter_turn_is_clockwise_on_the_screen() -> None:
    motion = motion_of(Augmentation(rotation_deg=90), width=100, height=100)
    assert move_points(np.array([[100.0, 50.0]]), motion)[0] == pytest.approx((50, 100))


def test_samples_stay_within_their_limits_and_repeat_with_their_seed() -> None:
    sampled = [sample_augmentation(np.random.default_rng(seed), most_rotation_deg=10) for seed in range(50)]
    assert all(abs(one.rotation_deg) <= 10 and 0.65 <= one.brightness <= 1.35 for one in sampled)
    assert {one.flip_horizontal for one in sampled} == {one.flip_vertical for one in sampled} == {True, False}
    assert sampled[7] == sample_augmentation(np.random.default_rng(7), most_rotation_deg=10)
