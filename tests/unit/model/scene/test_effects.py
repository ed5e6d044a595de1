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


def test_caps_closer_together_hide_more_of_each_other() -> None:
    near = rendered({"growth": {"spread": 0.6, "cluster": 15}}, count=4)
    far = rendered({"growth": {"spread": 1.6, "cluster": 1}}, count=4)
    assert hidden(near) > hidden(far) + 0.2


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

    plain = rendered({})
    assert fine(rendered({"camera": {"noise": 6}})) > 1.2 * fine(plain)
    assert fine(rendered({"camera": {"sharpness": 2.5}})) < 0.7 * fine(plain)


def test_an_oblique_camera_squeezes_caps_upright() -> None:
    def flatness(beds: list[Bed]) -> float:
        spans = [np.ptp(np.reshape(cap.whole, (-1, 2)), axis=0) for bed in beds for cap in bed.caps]
        return float(np.mean([high / wide for wide, high in spans]))

    assert flatness(rendered({"camera": {"pitch_deg": [40, 40]}})) < 0.93 * flatness(rendered({}))
