"""Crops: the caps in them are where the photo shows them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fairyring.model.geometry.raster import mask_of_outline
from fairyring.model.geometry.shapes import Circle, Outline, polygon_of_shape
from fairyring.model.train.augment import Augmentation
from fairyring.model.train.crops import LEAST_VISIBLE, Crop, CropConfig, cut_crop

WIDTH, HEIGHT, SIDE = 160, 112, 64
CAPS: list[Outline] = [
    [polygon_of_shape(Circle(40.3, 30.7, 17.2))],
    [polygon_of_shape(Circle(60.1, 52.4, 21.9))],
    [polygon_of_shape(Circle(110.6, 80.2, 14.4)), [130.1, 60.2, 150.3, 60.7, 141.2, 90.4]],
    [polygon_of_shape(Circle(2.2, 100.9, 12.3))],
]

IGNORED: Outline = [polygon_of_shape(Circle(80, 100, 30))]


def photo() -> NDArray[np.uint8]:
    return np.random.default_rng(3).integers(0, 256, (HEIGHT, WIDTH, 3), dtype=np.uint8)


def crop(augmentation: Augmentation, *, seed: int = 0, side: int = SIDE, **changes: object) -> Crop:
    return cut_crop(
        photo(),
        CAPS,
        [IGNORED],
        augmentation=augmentation,
        config=CropConfig(side=side, **changes),  # pyright: ignore
        rng=np.random.default_rng(seed),
    )


def place_of(piece: NDArray[np.uint8], whole: NDArray[np.uint8]) -> tuple[int, int]:
    """x, y where the piece is found in the whole, pixel by pixel."""
    side = len(piece)
    for y in range(whole.shape[0] - side + 1):
        for x in range(whole.shape[1] - side + 1):
            if np.array_equal(whole[y, x : x + side], piece[0]):
                assert np.array_equal(whole[y : y + side, x : x + side], piece)
                return x, y
    raise AssertionError("The crop is nowhere in the photo.")


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(("across", "down"), [(False, False), (True, False), (False, True), (True, True)])
def test_an_unturned_crop_is_a_piece_of_the_mirrored_photo_and_of_its_masks(
    seed: int, across: bool, down: bool
) -> None:
    made = crop(Augmentation(flip_horizontal=across, flip_vertical=down), seed=seed)
    mirror = np.s_[:: -1 if down else 1, :: -1 if across else 1]
    x, y = place_of(made.photo, photo()[mirror])
    window = np.s_[y : y + SIDE, x : x + SIDE]

    def shown(outline: Outline) -> NDArray[np.uint8]:
        points = [np.reshape(part, (-1, 2)) for part in outline]
        mirrored = [np.where([across, down], (WIDTH, HEIGHT) - part, part) for part in points]
        parts = [part.ravel().tolist() for part in mirrored]
        mask = mask_of_outline(parts, height=HEIGHT, width=WIDTH)[window]
        # The rasteriser decides ties to one side: mirrored, a few pixels of the rim change.
        as_seen = mask_of_outline(outline, height=HEIGHT, width=WIDTH)[mirror][window]
        assert int((mask != as_seen).sum()) <= 16
        return mask

    masks = [mask for cap in CAPS if (mask := shown(cap)).sum() >= LEAST_VISIBLE]
    assert len(made.masks) == len(masks)
    for mask, expected in zip(made.masks, masks, strict=True):
        # Beyond the crop's first row and column the rasteriser rounds a few pixels the other way.
        assert int((mask != expected).sum()) <= 4
    assert int((made.ignored != (shown(IGNORED) != 0)).sum()) <= 2


@settings(max_examples=25)
@given(
    st.booleans(),
    st.booleans(),
    st.floats(-180, 180),
    st.floats(0.7, 1.4),
    st.integers(0, 1000),
)
def test_masks_lie_where_the_photo_shows_their_caps(
    across: bool, down: bool, angle: float, scale: float, seed: int
) -> None:
    """The photo is the mask of one cap itself: whatever is done to both, they stay alike."""
    cap = CAPS[1]
    white = 255 * mask_of_outline(cap, height=HEIGHT, width=WIDTH)[..., None].repeat(3, axis=2)
    made = cut_crop(
        white,
        [cap],
        [],
        augmentation=Augmentation(flip_horizontal=across, flip_vertical=down, rotation_deg=angle),
        config=CropConfig(side=SIDE, scale=(scale, scale)),
        rng=np.random.default_rng(seed),
    )
    shown = made.photo[..., 0] > 127
    told = made.masks.any(0) if len(made.masks) else np.zeros_like(shown)
    # Of an edge through the crop, a ring of half pixels may differ.
    assert (shown != told).sum() <= max(1.5 * LEAST_VISIBLE, 0.06 * shown.sum())


def test_boxes_and_mass_centres_are_those_worked_out_by_hand() -> None:
    made = cut_crop(
        np.zeros((32, 32, 3), np.uint8),
        [[[4.0, 6.0, 14.0, 6.0, 14.0, 10.0, 4.0, 10.0]], [[20.0, 20.0, 30.0, 20.0, 30.0, 30.0]]],
        [],
        augmentation=Augmentation(),
        config=CropConfig(side=32),
        rng=np.random.default_rng(0),
    )
    assert made.boxes[0].tolist() == [4, 6, 10, 4]
    assert made.centres[0].tolist() == [9, 8]
    for mask, box, centre in zip(made.masks, made.boxes, made.centres, strict=True):
        rows, columns = np.nonzero(mask)
        assert centre == pytest.approx((columns.mean() + 0.5, rows.mean() + 0.5))
        left, top = columns.min(), rows.min()
        assert box.tolist() == [left, top, columns.max() + 1 - left, rows.max() + 1 - top]


def test_next_to_nothing_of_a_cap_is_left_out() -> None:
    def seen(width: float) -> int:
        part = [-20.0, 10.0, width, 10.0, width, 18.0, -20.0, 18.0]
        made = cut_crop(
            np.zeros((32, 32, 3), np.uint8),
            [[part]],
            [],
            augmentation=Augmentation(),
            config=CropConfig(side=32),
            rng=np.random.default_rng(0),
        )
        return len(made.masks)

    # Eight rows of two pixels, and of three.
    assert (seen(2.0), seen(3.0)) == (0, 1)
    assert LEAST_VISIBLE == 24


def test_a_crop_without_caps_is_whole_all_the_same() -> None:
    made = cut_crop(
        photo(),
        [],
        [],
        augmentation=Augmentation(),
        config=CropConfig(side=SIDE),
        rng=np.random.default_rng(0),
    )
    assert made.masks.shape == (0, SIDE, SIDE)
    assert made.boxes.shape == (0, 4)
    assert made.centres.shape == (0, 2)
    assert not made.ignored.any()


def test_light_and_noise_leave_geometry_alone() -> None:
    turned = Augmentation(flip_horizontal=True, rotation_deg=33)
    plain = crop(turned, seed=5)
    changed = crop(
        Augmentation(flip_horizontal=True, rotation_deg=33, brightness=1.3),
        seed=5,
        most_gain=0.2,
        most_gamma=0.3,
        most_blur_px=2.0,
        most_noise=9.0,
    )
    assert not np.array_equal(plain.photo, changed.photo)
    np.testing.assert_array_equal(plain.masks, changed.masks)
    np.testing.assert_array_equal(plain.boxes, changed.boxes)
    np.testing.assert_array_equal(plain.centres, changed.centres)
    np.testing.assert_array_equal(plain.ignored, changed.ignored)
    assert plain.origin == changed.origin


def test_brightness_is_a_factor_on_grey_levels() -> None:
    plain, bright = crop(Augmentation()), crop(Augmentation(brightness=1.25))
    expected = np.clip(np.round(plain.photo * 1.25), 0, 255)
    assert np.abs(bright.photo - expected).max() <= 0.5


def test_a_photo_smaller_than_the_crop_lies_in_its_middle_on_black() -> None:
    made = crop(Augmentation(), side=192)
    left, top = (192 - WIDTH) // 2, (192 - HEIGHT) // 2
    np.testing.assert_array_equal(made.photo[top : top + HEIGHT, left : left + WIDTH], photo())
    assert made.photo.astype(int).sum() == photo().astype(int).sum()
    assert len(made.masks) == len(CAPS)


def test_scale_enlarges_caps() -> None:
    caps = [[polygon_of_shape(Circle(80, 56, 20), chord_error=0.01)]]
    made = cut_crop(
        photo(),
        caps,
        [],
        augmentation=Augmentation(),
        config=CropConfig(side=256, scale=(1.5, 1.5)),
        rng=np.random.default_rng(0),
    )
    assert made.masks[0].sum() == pytest.approx(math.pi * 30**2, rel=0.02)
    assert made.centres[0] == pytest.approx((128, 128), abs=0.1)


def test_a_crop_of_a_photo_labelled_in_part_shows_a_cap_and_ignores_all_else() -> None:
    caps: list[Outline] = [[polygon_of_shape(Circle(20, 90, 9))], [polygon_of_shape(Circle(140, 15, 9))]]
    shown = set()
    for seed in range(40):
        made = cut_crop(
            photo(),
            caps,
            [],
            complete=False,
            augmentation=Augmentation(rotation_deg=10, flip_horizontal=bool(seed % 2)),
            config=CropConfig(side=32),
            rng=np.random.default_rng(seed),
        )
        assert len(made.masks) == 1
        np.testing.assert_array_equal(made.ignored, made.masks[0] == 0)
        shown.add(made.masks[0].tobytes())
    assert len(shown) > 30


def test_crops_come_from_all_over_the_photo() -> None:
    columns = np.arange(WIDTH, dtype=np.uint8)[None, :, None].repeat(HEIGHT, 0).repeat(3, 2)
    firsts = []
    for seed in range(400):
        made = cut_crop(
            columns,
            [],
            [],
            augmentation=Augmentation(),
            config=CropConfig(side=SIDE),
            rng=np.random.default_rng(seed),
        )
        firsts.append(int(made.photo[0, 0, 0]))
    assert min(firsts) <= 2
    assert max(firsts) >= WIDTH - SIDE - 3
    assert np.mean(firsts) == pytest.approx((WIDTH - SIDE) / 2, abs=6)
