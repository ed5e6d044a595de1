"""Small beds that render in a blink, shared by the tests of the renderer."""

from __future__ import annotations

from typing import Any

from fairyring.model.scene.presets import preset
from fairyring.model.scene.settings import Settings, changed


def small(**growth: Any) -> Settings:
    """A picture of 320×200 with about 25 caps."""
    sizes = {"caps": (22, 28), "diameters": (12, 18, 30, 50, 70)}
    return changed(preset("default"), {"width": 320, "height": 200, "growth": sizes | growth})
