"""Every setting does what it says: pictures and truths with it and without it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from fairyring.model.scene.bed import Bed, render_bed
from fairyring.model.scene.settings import changed
from tests.support.small_beds import small

PLAIN = {"forms": [""], "lights": ["top"], "camera": {"tint": 0, "pitch_deg": [0, 0]}, "soil": {"edge": 0}}


def rendered(changes: dict[str, Any], *, count: int = 2) -> list[Bed]:
    settings = changed(changed(small(), PLAIN), changes)
    return [render_bed(settings, seed=6, index=index) for index in range(count)]


def hidden(beds: list[Bed]) -> float:
    return float(np.mean([cap.visible_fraction < 0.95 for bed in beds for cap in bed.caps]))


def cap_colour(beds: list[Bed]) -> np.ndarray:
    return np.mean([bed.image[bed.owners > 0].mean(axis=0) for bed in beds], axis=0)


def soil_brightness(beds: list[Bed]) -> float:
    return float(np.mean([bed.image[bed.owners == 0].mean() for bed in beds]))


def contrast_on_caps(beds: list[Bed]) -> float:
    return float(np.mean([bed.image[bed.owners > 0].std() for bed in beds]))


def step_across_rims(bed: Bed) -> float:
    """Median change of brightness between neighbouring pixels of two caps."""
    left, right = bed.owners[:, :-1], bed.owners[:, 1:]
    grey = bed.image.mean(axis=2)
    return float(np.median(np.abs(np.diff(grey, axis=1))[(left != right) & (left > 0) & (right > 0)]))


def test_caps_closer_together_hide_more_of_each_other() -> None:
    near = rendered({"growth": {"spread": 0.6, "cluster": 15}}, count=4)
    far = rendered({"growth": {"spread": 1.6, "cluster": 1}}, count=4)
    assert hidden(near) > hidden(far) + 0.15


def test_diameters_follow_their_quantiles() -> None:
    quantiles = (14, 20, 30, 44, 60)
    changes = {"growth": {"diameters": quantiles, "irregularity": 0, "squeeze": 0, "lean_deg": 0}}
    found = [cap.diameter for bed in rendered(changes, count=8) for cap in bed.caps]
    assert np.percentile(found, [10, 50, 90]) == pytest.approx(quantiles[1:4], rel=0.15)


def test_squeezed_caps_are_less_round() -> None:
    def roundness(beds: list[Bed]) -> float:
        return float(np.mean([cap.ellipse.b / cap.ellipse.a for bed in beds for cap in bed.caps]))

    assert roundness(rendered({"forms": ["f"]})) < roundness(rendered({"growth": {"irregularity": 0}})) - 0.03


def test_tilted_mushrooms_show_their_stalks() -> None:
    def stalks(beds: list[Bed]) -> int:
        return sum(int((bed.owners < 0).sum()) for bed in beds)

    assert stalks(rendered({"forms": ["g"]})) > 2 * stalks(rendered({}))


def test_brown_caps_are_brown_and_white_ones_white() -> None:
    blue, green, red = cap_colour(rendered({"skin": {"brown": [1, 1]}}))
    assert blue < 0.85 * green < 0.85 * red
    blue, _, red = cap_colour(rendered({"skin": {"brown": [0, 0]}}))
    assert red / blue == pytest.approx(1, abs=0.12)


@pytest.mark.parametrize("mark", ["scales", "spots", "soil", "damage"])
def test_scales_spots_soil_and_damage_raise_the_contrast_on_caps(mark: str) -> None:
    clean = {"scales": 0, "spots": 0, "soil": 0, "damage": 0}
    assert contrast_on_caps(rendered({"skin": clean | {mark: 1}})) > contrast_on_caps(
        rendered({"skin": clean})
    )


@pytest.mark.parametrize("setting", ["brightness", "mycelium", "pinheads"])
def test_the_soil_gets_brighter_with_what_lies_on_it(setting: str) -> None:
    little, much = rendered({"soil": {setting: [0, 0]}}), rendered({"soil": {setting: [1, 1]}})
    assert soil_brightness(much) > soil_brightness(little) + 2


def test_the_bed_ends_where_the_edge_is() -> None:
    without, ending = rendered({"soil": {"edge": 0}}), rendered({"soil": {"edge": 1}})
    dark = [min(bed.image[:, :8].mean(), bed.image[:, -8:].mean()) for bed in ending]
    assert np.mean(dark) < 12 < np.mean([bed.image[:, :8].mean() for bed in without])


def test_dark_light_is_dark_and_noisy_and_side_light_uneven() -> None:
    top, side, dark = (rendered({"lights": [light]}) for light in ("top", "side", "dark"))
    assert cap_colour(dark).mean() < 0.75 * cap_colour(top).mean()
    assert contrast_on_caps(side) > 1.3 * contrast_on_caps(top)


def test_noise_and_blur_of_the_camera_can_be_set() -> None:
    def fine(beds: list[Bed]) -> float:
        return float(np.mean([np.abs(np.diff(bed.image[..., 1].astype(int), axis=1)).mean() for bed in beds]))

    assert fine(rendered({"camera": {"noise": 6}})) > 1.2 * fine(rendered({}))
    sharp, blurred = ({"camera": {"noise": 0, "defocus": 0, "sharpness": blur}} for blur in (0.7, 2.5))
    assert fine(rendered(blurred)) < 0.7 * fine(rendered(sharp))


def test_an_oblique_camera_squeezes_caps_upright() -> None:
    def flatness(beds: list[Bed]) -> float:
        spans = [np.ptp(np.reshape(cap.whole, (-1, 2)), axis=0) for bed in beds for cap in bed.caps]
        return float(np.mean([high / wide for wide, high in spans]))

    assert flatness(rendered({"camera": {"pitch_deg": [40, 40]}})) < 0.93 * flatness(rendered({}))


def test_late_caps_look_out_from_behind_others() -> None:
    assert hidden(rendered({"growth": {"tucked": 1}}, count=4)) > hidden(rendered({}, count=4)) + 0.05


def test_fused_feet_brighten_the_gaps() -> None:
    growth = {"spread": 0.6, "cluster": 15}
    bare = rendered({"growth": growth | {"fused": [0, 0]}}, count=4)
    fused = rendered({"growth": growth | {"fused": [1, 1]}}, count=4)
    assert soil_brightness(fused) > soil_brightness(bare) + 1


@pytest.mark.parametrize(("setting", "little", "much"), [("interreflection", 0, 1), ("translucency", 0, 4)])
def test_light_in_and_between_caps_softens_the_rims_they_share(
    setting: str, little: float, much: float
) -> None:
    def steepest(value: float) -> float:
        flesh = {"interreflection": [1, 1], "translucency": [0, 0]} | {setting: [value, value]}
        changes = {"growth": {"spread": 0.6, "cluster": 15}, "flesh": flesh}
        return float(np.median([step_across_rims(bed) for bed in rendered(changes, count=3)]))

    assert steepest(much) < 0.85 * steepest(little)


def test_what_is_out_of_focus_is_blurred() -> None:
    def fine(defocus: float) -> float:
        beds = rendered({"camera": {"defocus": defocus, "focus": [1, 1], "noise": 0}})
        return float(np.mean([np.abs(np.diff(bed.image[..., 1].astype(int), axis=1)).mean() for bed in beds]))

    assert fine(10) < 0.8 * fine(0)
    sharp, blurred = (rendered({"camera": {"defocus": defocus}}) for defocus in (0, 10))
    # A blurred rim is still where it is.
    assert all((one.owners == other.owners).all() for one, other in zip(sharp, blurred, strict=True))


def test_a_zoom_makes_fewer_and_larger_caps() -> None:
    def count_and_size(zoom: float) -> tuple[float, float]:
        beds = rendered({"growth": {"zoom": [zoom, zoom]}}, count=4)
        diameters = [cap.diameter for bed in beds for cap in bed.caps]
        return len(diameters) / len(beds), float(np.median(diameters))

    (count, size), (fewer, larger) = count_and_size(1.0), count_and_size(2.0)
    assert fewer == pytest.approx(count / 4, rel=0.25)
    # Of two dozen caps the median is a rough one.
    assert larger > 1.3 * size
