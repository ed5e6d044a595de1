"""The kinds of beds that the paper tells apart: by the light on them and by the form of what grows there."""

from __future__ import annotations

from enum import StrEnum


class LightSource(StrEnum):
    """The light sources of the paper's Figure 4."""

    top = "top"
    side = "side"
    dark = "dark"


LIGHTS = tuple(LightSource)
FORMS = tuple("abcdefgh")
"""The forms of the paper's Figure 3."""
