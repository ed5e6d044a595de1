"""Wrong settings get a sentence."""

from __future__ import annotations

from typing import Any

import pytest

from fairyring.model.scene.presets import PRESETS, preset, with_form
from fairyring.model.scene.settings import FORMS, SceneError, Settings, changed


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"growth": {"colour": 3}}, "colour"),
        ({"growth": {"spread": -1}}, "spread"),
        ({"growth": {"caps": [90, 20]}}, "growth.caps"),
        ({"growth": {"diameters": [10, 20, 30]}}, "diameters"),
        ({"growth": {"diameters": [30, 20, 40, 50, 60]}}, "diameters"),
        ({"growth": {"zoom": [2, 1]}}, "growth.zoom"),
        ({"growth": {"fused": [0, 2]}}, "fused"),
        ({"flesh": {"translucency": [3, 1]}}, "flesh.translucency"),
        ({"flesh": {"interreflection": [0, 2]}}, "interreflection"),
        ({"camera": {"focus": [0.9, 0.1]}}, "camera.focus"),
        ({"skin": {"brown": [0, 2]}}, "brown"),
        ({"camera": {"pitch_deg": [0, 80]}}, "pitch_deg"),
        ({"lights": ["sun"]}, "lights"),
        ({"lights": []}, "lights"),
        ({"forms": ["z"]}, "forms"),
        ({"width": "wide"}, "width"),
        ({"growth": 7}, "growth"),
    ],
)
def test_a_setting_out_of_its_range_is_named(changes: dict[str, Any], word: str) -> None:
    with pytest.raises(SceneError, match=word) as caught:
        changed(Settings(), changes)
    assert "\n" not in str(caught.value)


def test_an_unknown_preset_is_named_beside_those_there_are() -> None:
    with pytest.raises(SceneError, match=r"'plot'.*default, paper, farm, mixed"):
        preset("plot")


def test_changes_leave_the_other_settings_alone() -> None:
    settings = changed(Settings(), {"growth": {"squeeze": 0.9}})
    assert settings.growth.squeeze == 0.9
    assert settings.growth.spread == Settings().growth.spread
    assert settings.skin == Settings().skin


@pytest.mark.parametrize("name", PRESETS)
@pytest.mark.parametrize("form", FORMS)
def test_every_form_of_every_preset_makes_settings_within_their_ranges(name: str, form: str) -> None:
    settings = with_form(preset(name), form)
    assert settings != preset(name)
    assert changed(settings, {}) == settings
