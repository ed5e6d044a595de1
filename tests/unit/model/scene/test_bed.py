"""The truth about a rendered bed, checked against the masks it is told in and against the picture."""

from __future__ import annotations

import numpy as np
import pytest

from fairyring.model.geometry.raster import mask_of_outline
from fairyring.model.geometry.shapes import area_of_outline, bounds_of_outline
from fairyring.model.scene.bed import Bed, kind_of, render_bed
from fairyring.model.scene.presets import preset
from fairyring.model.scene.settings import changed
from tests.support.small_beds import small

WIDTH, HEIGHT, AROUND = 320, 200, 120


@pytest.fixture(scope="module", params=["d", "g"])
def bed(request: pytest.FixtureRequest) -> Bed:
    return render_bed(changed(small(), {"forms": [request.param], "lights": ["top"]}), seed=5)


def seen(bed: Bed) -> list[np.ndarray]:
    return [mask_of_outline(cap.visible, height=HEIGHT, width=WIDTH) != 0 for cap in bed.caps]


def wholes(bed: Bed) -> list[np.ndarray]:
    """Drawn in a frame wide enough that none is cut."""
    frames = []
    for cap in bed.caps:
        moved = [value + AROUND for value in cap.whole]
        frames.append(mask_of_outline([moved], height=HEIGHT + 2 * AROUND, width=WIDTH + 2 * AROUND) != 0)
    return frames


def test_the_same_seed_gives_the_same_bytes_whatever_was_rendered_before() -> None:
    alone = render_bed(small(), seed=3, index=7)
    render_bed(small(), seed=3, index=2)
    again = render_bed(small(), seed=3, index=7)
    assert alone.image.tobytes() == again.image.tobytes()
    assert alone.caps == again.caps
    assert render_bed(small(), seed=4, index=7).image.tobytes() != alone.image.tobytes()


def test_the_visible_masks_are_exactly_the_pixels_of_the_caps(bed: Bed) -> None:
    masks = seen(bed)
    assert np.sum(masks, axis=0).max() == 1
    np.testing.assert_array_equal(np.any(masks, axis=0), bed.owners > 0)


def test_a_whole_outline_contains_the_visible_one(bed: Bed) -> None:
    for visible, whole in zip(seen(bed), wholes(bed), strict=True):
        assert not (visible & ~whole[AROUND:-AROUND, AROUND:-AROUND]).any()


def test_no_pixel_belongs_to_a_cap_under_another(bed: Bed) -> None:
    covered = [whole[AROUND:-AROUND, AROUND:-AROUND] for whole in wholes(bed)]
    for low, visible in enumerate(seen(bed)):
        for high in covered[low + 1 :]:
            assert not (visible & high).any()


def test_what_is_hidden_of_a_cap_is_hidden_by_a_cap_above_a_stalk_or_the_border(bed: Bed) -> None:
    covered = [whole[AROUND:-AROUND, AROUND:-AROUND] for whole in wholes(bed)]
    for low, (visible, whole) in enumerate(zip(seen(bed), covered, strict=True)):
        above = np.any([bed.owners < 0, *covered[low + 1 :]], axis=0)
        assert not (whole & ~visible & ~above).any()


def test_the_visible_fraction_counts_what_lies_outside_the_image_as_hidden(bed: Bed) -> None:
    for cap, visible, whole in zip(bed.caps, seen(bed), wholes(bed), strict=True):
        assert cap.visible_fraction == pytest.approx(visible.sum() / whole.sum(), abs=1e-12)


def test_a_cap_with_nothing_above_it_is_fully_visible(bed: Bed) -> None:
    free = 0
    everywhere = wholes(bed)
    for low, (cap, whole) in enumerate(zip(bed.caps, everywhere, strict=True)):
        inside = whole[AROUND:-AROUND, AROUND:-AROUND]
        above = np.any([whole & other for other in everywhere[low + 1 :]])
        if inside.sum() == whole.sum() and not above and not (inside & (bed.owners < 0)).any():
            free += 1
            assert cap.visible_fraction == 1
    assert free > 1


def test_the_ellipse_follows_the_whole_outline(bed: Bed) -> None:
    for cap in bed.caps:
        assert np.pi * cap.ellipse.a * cap.ellipse.b == pytest.approx(area_of_outline([cap.whole]), rel=0.06)
        x, y, width, height = bounds_of_outline([cap.whole])
        assert abs(cap.centre[0] - (x + width / 2)) < 0.12 * width + 0.5
        assert abs(cap.centre[1] - (y + height / 2)) < 0.12 * height + 0.5


def test_the_picture_shows_what_the_truth_says() -> None:
    # White caps on black soil without anything else white: bright pixels are caps or stalks.
    plain = {
        "forms": [""],
        "lights": ["top"],
        "growth": {"fused": [0, 0]},
        "skin": {"brown": [0, 0], "specks": 0},
        "soil": {"brightness": [0, 0], "mycelium": [0, 0], "pinheads": [0, 0], "litter": 0, "edge": 0},
        "camera": {"defocus": 0, "sharpness": 0.4, "black": [0, 0], "crispness": [0, 0]},
    }
    bed = render_bed(changed(small(), plain), seed=2)
    bright = bed.image.mean(axis=2) > 65
    flesh = bed.owners != 0
    assert (bright & flesh).sum() / (bright | flesh).sum() > 0.95


def test_caps_are_counted_in_the_range_asked_for() -> None:
    for index in range(5):
        assert 30 <= len(render_bed(small(caps=(30, 33)), seed=1, index=index).caps) <= 33


def test_forms_and_lights_come_equally_often_in_every_pair() -> None:
    kinds = [kind_of(preset("paper"), index) for index in range(480)]
    assert len(set(kinds)) == 24
    assert all(kinds.count(kind) == 20 for kind in set(kinds))
    same_length = changed(preset("paper"), {"forms": ["a", "b", "c"]})
    assert len({kind_of(same_length, index) for index in range(9)}) == 9
