"""Light and shade on a plane with one block on it."""

from __future__ import annotations

import numpy as np

from fairyring.model.scene.light import Light
from fairyring.model.scene.pixels import Image
from fairyring.model.scene.shade import cast_shade
from fairyring.model.scene.shine import shine

ROWS, COLUMNS = 160, 240
BLOCK = np.s_[70:90, 100:130]


def light(*, elevation_deg: float, sky: float = 0.2, softness: float = 0.05) -> Light:
    """From the left."""
    elevation = np.radians(elevation_deg)
    return Light(
        direction=np.array([-np.cos(elevation), 0, np.sin(elevation)], np.float32),
        elevation=float(elevation),
        key=np.ones(3, np.float32),
        sky=np.full(3, sky, np.float32),
        softness=softness,
        slant=0.0,
        height=1000.0,
        gloss=0.0,
        dimness=1.0,
    )


def lit_plane(source: Light, *, height: float) -> Image:
    z = np.zeros((ROWS, COLUMNS), np.float32)
    z[BLOCK] = height
    flat = np.stack([np.zeros_like(z), np.zeros_like(z), np.ones_like(z)])
    return shine(flat, z, light=source, shade=cast_shade(z, source)).light[1]


def test_a_shadow_falls_away_from_the_light_as_far_as_the_height_says() -> None:
    lit = lit_plane(light(elevation_deg=45), height=40)
    row, free = lit[80], lit[20, 200]
    assert row[140:160].max() < 0.6 * free
    assert row[190:].min() > 0.9 * free
    assert row[60:80].min() > 0.8 * free


def test_of_a_soft_light_more_comes_in_beneath_what_hangs_over() -> None:
    def beneath(softness: float) -> float:
        lit = lit_plane(light(elevation_deg=45, sky=0.0, softness=softness), height=60)
        return float(lit[80, 150] / lit[20, 200])

    assert beneath(0.02) < 0.1
    assert beneath(0.3) > 0.4


def test_a_low_light_casts_longer_shadows() -> None:
    def shaded(elevation_deg: float) -> int:
        lit = lit_plane(light(elevation_deg=elevation_deg), height=20)
        return int((lit[80, 130:] < 0.7 * lit[20, 230]).sum())

    assert shaded(20) > 1.7 * shaded(45) > 0


def test_the_foot_of_a_block_is_darker_than_open_ground() -> None:
    lit = lit_plane(light(elevation_deg=75), height=60)
    assert lit[80, 97] < 0.95 * lit[20, 20]
